#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace morphbake {

/// Whether a name has wildcards: * ? [
bool is_pattern(const std::string& name);

/// The folder before the first wildcard; "" for the current one.
std::filesystem::path folder_before_wildcards(const std::string& pattern);

/// The regular files that a pattern names, in the order of their names' bytes.
///
/// As a shell has it: * ? and [...] inside of a name, ** for any folders, also none. Names that
/// begin with a dot must be asked for by one; ** follows no links to folders, so that circles of
/// links end.
std::vector<std::filesystem::path> files_matching(const std::string& pattern);

}  // namespace morphbake
