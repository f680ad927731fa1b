#include "morphbake/diagnostics/observer.h"

namespace morphbake {

void report(const Observer& observer, const Problem& problem) {
  if (observer.on_problem) observer.on_problem(problem);
}

void stop_if_cancelled(const Observer& observer) {
  if (observer.is_cancelled && observer.is_cancelled()) throw Cancelled();
}

void advance(const Observer& observer, const Progress& progress) {
  if (observer.on_progress) observer.on_progress(progress);
  stop_if_cancelled(observer);
}

}  // namespace morphbake
