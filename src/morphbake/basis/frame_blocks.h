#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/solve/frame_source.h"

namespace morphbake {

/// All frames of some vertices, as displacements from the first frame: a row a frame, the columns
/// are x, y, z of one vertex after the other.
using FrameBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Vertices that stand in a block, beside each other.
struct VertexRange {
  Eigen::Index first = 0;
  Eigen::Index count = 0;
};

/// The vertices of `frames` in parts of which each block fits into caches.
std::vector<VertexRange> block_ranges(const FrameSource& frames);

FrameBlock read_block(const FrameSource& frames, const VertexRange& range);

/// All frames of single vertices.
FrameBlock read_vertices(const FrameSource& frames, const std::vector<Eigen::Index>& vertices);

/// Calls `work` for every part on some thread, then `finish` for the same parts in their order on
/// the caller's: nothing depends on the number of threads, and a few blocks are in memory.
void for_each_block(const FrameSource& frames, const Observer& observer,
                    const std::function<void(std::size_t part, const FrameBlock& block)>& work,
                    const std::function<void(std::size_t part)>& finish);

/// Frames that are told by fewer shapes: how far each vertex of a block is at most from where it
/// ought to be.
using Deviation = std::function<Eigen::VectorXd(const FrameBlock& block)>;

/// Vertices that are farther away than `tolerance`: the worst few of the worst few of each part.
std::vector<Eigen::Index> strays(const FrameSource& frames, const Deviation& deviation,
                                 double tolerance, const Observer& observer);

/// Vertices that stand for all others until some are found that do not keep up.
std::vector<Eigen::Index> spread_vertices(const FrameSource& frames);

}  // namespace morphbake
