#pragma once

#include <functional>
#include <vector>

#include "morphbake/solve/solve_frames.h"

namespace morphbake {

/// The frames of a timeline, pulled one by one as often as needed: whoever reads them holds what it
/// needs, and memory does not grow with their number.
struct FrameSource {
  std::vector<double> times;                              ///< seconds, rising
  std::function<Positions(std::size_t frame)> positions;  ///< #V by 3, scene space
};

/// Frames combined from solved shapes, each time anew.
///
/// @param shapes, separable, timeline  must outlive the source
FrameSource combined_frames(const SolvedShapes& shapes, const SeparableTimeline& separable,
                            const Timeline& timeline);

struct SolvedFrames {
  FrameSource source;
  std::vector<SolveRecord> records;  ///< one a frame that needed a solve
};

/// Frames that were solved one by one, kept in a scratch file that vanishes with the source.
///
/// @param reference  #V by 3: what displacements start from
/// @throws BakeError "output.unwritable" when there is no room for the scratch file
SolvedFrames solved_frames(const SurfaceSolver& solver, const Positions& reference,
                           const std::vector<double>& times, const GoalsAt& goals_at,
                           const Observer& observer);

}  // namespace morphbake
