#include "morphbake/diagnostics/observer.h"

namespace morphbake {

void report(const Observer& observer, const Problem& problem) {
  if (observer.on_problem) observer.on_problem(problem);
}

void advance(const Observer& observer, const Progress& progress) {
  if (observer.on_progress) observer.on_progress(progress);
  if (observer.is_cancelled && observer.is_cancelled()) throw Cancelled();
}

}  // namespace morphbake
