#pragma once

#include <string>

namespace morphbake {

/// How long a stage, or a step of one, took.
struct StageReport {
  std::string name;
  double seconds = 0;
};

}  // namespace morphbake
