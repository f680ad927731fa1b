#pragma once

#include <string>
#include <vector>

#include "morphbake/diff/file_difference.h"

namespace morphbake::cli {

/// What two files do not have in common as a table for people: per mesh and clip the worst vertex,
/// when, and by how much; then what differs, then what is only noted.
std::vector<std::string> difference_lines(const FileDifference& difference);

}  // namespace morphbake::cli
