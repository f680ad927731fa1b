#pragma once

#include <string>

namespace morphbake {

/// "1 vertex is", "2 vertices are": a number and what it counts, for messages.
std::string counted(int count, const std::string& one, const std::string& several);

}  // namespace morphbake
