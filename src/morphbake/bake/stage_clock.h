#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "morphbake/bake/stage_report.h"
#include "morphbake/diagnostics/observer.h"

namespace morphbake {

/// Announces stages to the observer and notes how long each took.
class StageClock {
 public:
  explicit StageClock(const Observer& observer) : observer_(observer) {}

  /// Ends the running stage and starts `name`. Throws Cancelled.
  void start(const std::string& name);

  /// Ends the running stage.
  std::vector<StageReport> finish();

 private:
  using Clock = std::chrono::steady_clock;

  void end_running();

  const Observer& observer_;
  std::vector<StageReport> stages_;
  Clock::time_point began_;
};

}  // namespace morphbake
