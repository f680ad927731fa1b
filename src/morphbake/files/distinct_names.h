#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace morphbake {

/// What files are called beside one another: their names, where those are not all different as much
/// of the ends of their paths as tells them apart. A file that is there twice gets a number.
///
/// @return  one a file, all different
std::vector<std::string> distinct_names(const std::vector<std::filesystem::path>& files);

}  // namespace morphbake
