#pragma once

#include "morphbake/bake/solve_timeline.h"
#include "morphbake/bake/timeline_changes.h"

namespace morphbake {

/// The anchor's own equation is not met: by how much, that is how far the vertex stands out of its
/// neighbours.
///
/// @param changes  of the timeline; its fields are in `solved`
/// @throws Cancelled
void warn_of_spike(const Recipe& recipe, const MorphableMesh& mesh, const SolvedTimeline& solved,
                   const TimelineChanges& changes, const Observer& observer);

}  // namespace morphbake
