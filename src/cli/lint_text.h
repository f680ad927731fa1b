#pragma once

#include <string>
#include <vector>

#include "morphbake/lint/lint.h"

namespace morphbake::cli {

/// What a lint found, in lines for people.
///
/// @param hides_notes  only what is worth doing something about
std::vector<std::string> lint_lines(const LintReport& report, const Profile& profile,
                                    bool hides_notes);

/// All shipped profiles and all rules, in lines for people.
std::vector<std::string> rule_lines();

/// "three.js 1.2 MB, ...": GPU memory of targets.
std::string shown_memory(const std::vector<GpuMemory>& memory);

}  // namespace morphbake::cli
