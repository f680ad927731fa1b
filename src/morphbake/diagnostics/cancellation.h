#pragma once

#include "morphbake/diagnostics/observer.h"

namespace morphbake {

/// Throws Cancelled when the caller has asked to stop; on any thread.
inline void stop_if_cancelled(const Observer& observer) {
  if (observer.is_cancelled && observer.is_cancelled()) throw Cancelled();
}

}  // namespace morphbake
