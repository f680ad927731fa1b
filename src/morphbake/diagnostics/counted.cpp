#include "morphbake/diagnostics/counted.h"

#include <fmt/core.h>

namespace morphbake {

std::string counted(int count, const std::string& one, const std::string& several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

}  // namespace morphbake
