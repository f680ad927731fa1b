#pragma once

#include <string>
#include <vector>

#include "morphbake/bake/compare.h"

namespace morphbake::cli {

/// What was measured as tables for people: the files, the worst of each measure, then each measure
/// over time, a column a file.
std::vector<std::string> comparison_lines(const Comparison& comparison);

/// All of it, for programs.
std::string comparison_json(const Comparison& comparison);

}  // namespace morphbake::cli
