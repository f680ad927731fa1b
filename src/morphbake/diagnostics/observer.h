#pragma once

#include <functional>
#include <string_view>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {

/// How far a stage is: `done` of `total` steps.
struct Progress {
  std::string_view stage;
  int done = 0;
  int total = 0;
};

/// What the caller wants to hear. Every function may be empty; all are called on the calling
/// thread but `is_cancelled`, which is asked on any, on several at once.
struct Observer {
  std::function<void(const Problem&)> on_problem;  ///< warnings; errors are thrown
  std::function<void(const Progress&)> on_progress;
  std::function<bool()> is_cancelled;
};

void report(const Observer& observer, const Problem& problem);

/// Throws Cancelled when the caller has asked to stop; on any thread.
void stop_if_cancelled(const Observer& observer);

/// Announces progress and throws Cancelled when the caller has asked to stop.
void advance(const Observer& observer, const Progress& progress);

}  // namespace morphbake
