#pragma once

#include <functional>
#include <span>
#include <vector>

#include "morphbake/solve/solve_fields.h"

namespace morphbake {

/// What some moments ask of the surface; called from several threads.
using GoalsAt = std::function<std::vector<Goal>(std::span<const double> times)>;

/// Takes frames in the order of time.
using FrameConsumer = std::function<void(int frame, const Positions& displacement)>;

/// Solves every frame of a timeline, each from a start close by, and hands them on chunk by chunk:
/// memory does not grow with their number.
///
/// What is carried from frame to frame is how far solutions are from the blend of the sources,
/// which changes slower than they do. `warm` starts all frames of a chunk from that of the last one
/// before it, so that they share passes over the factor. `direct` starts from the blend alone.
/// Iterations go through time, each frame from the line through the last two. Chunks depend on the
/// number of vertices, never on threads.
/// @return           one record a frame that needed a solve
std::vector<SolveRecord> solve_frames(const SurfaceSolver& solver, const std::vector<double>& times,
                                      const GoalsAt& goals_at, const Observer& observer,
                                      const FrameConsumer& consumer);

}  // namespace morphbake
