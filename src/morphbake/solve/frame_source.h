#pragma once

#include <functional>
#include <vector>

#include "morphbake/solve/solve_frames.h"

namespace morphbake {

/// Some vertices of a frame.
struct FramePart {
  std::size_t frame = 0;
  Eigen::Index first = 0;  ///< vertex
  Eigen::Index count = 0;  ///< vertices
};

/// The frames of a timeline, pulled part by part as often as needed: whoever reads them holds what
/// it needs, and memory does not grow with their number.
struct FrameSource {
  std::vector<double> times;  ///< seconds, rising
  Eigen::Index vertex_count = 0;
  /// count by 3, scene space. May be called from several threads at once.
  std::function<Positions(const FramePart& part)> rows;

  /// #V by 3, scene space.
  Positions positions(std::size_t frame) const { return rows({frame, 0, vertex_count}); }
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
