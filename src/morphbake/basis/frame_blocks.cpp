#include "morphbake/basis/frame_blocks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace morphbake {
namespace {

constexpr double kBlockBytes = 8e6;
constexpr std::size_t kPartsAtOnce = 8;   // in memory, whatever the number of threads
constexpr std::size_t kStraysAPart = 16;  // more would be neighbours of these
constexpr double kSeenBytes = 64e6;       // of vertices that are looked at by themselves
constexpr double kMostSeen = 1000;

double bytes_a_vertex(const FrameSource& frames) {
  return 3 * sizeof(double) * static_cast<double>(frames.times.size());
}

/// How many vertices to look at by themselves: fewer of long motions.
Eigen::Index count_to_see(const FrameSource& frames) {
  return static_cast<Eigen::Index>(std::clamp(kSeenBytes / bytes_a_vertex(frames), 1.0, kMostSeen));
}

}  // namespace

std::vector<VertexRange> block_ranges(const FrameSource& frames) {
  const auto length =
      static_cast<Eigen::Index>(std::clamp(kBlockBytes / bytes_a_vertex(frames), 16.0, 8192.0));
  std::vector<VertexRange> ranges;
  for (Eigen::Index first = 0; first < frames.vertex_count; first += length) {
    ranges.push_back({first, std::min(length, frames.vertex_count - first)});
  }
  return ranges;
}

FrameBlock read_block(const FrameSource& frames, const VertexRange& range) {
  FrameBlock block(frames.times.size(), 3 * range.count);
  const Positions start = frames.rows({0, range.first, range.count});
  for (std::size_t f = 0; f < frames.times.size(); ++f) {
    const Positions moved = frames.rows({f, range.first, range.count}) - start;
    block.row(static_cast<Eigen::Index>(f)) =
        Eigen::Map<const Eigen::RowVectorXd>(moved.data(), moved.size());
  }
  return block;
}

FrameBlock read_vertices(const FrameSource& frames, const std::vector<Eigen::Index>& vertices) {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  FrameBlock block(frames.times.size(), 3 * count);
  const Positions start = frames.positions(0)(vertices, Eigen::all);
  for (std::size_t f = 0; f < frames.times.size(); ++f) {
    const Positions moved = frames.positions(f)(vertices, Eigen::all) - start;
    block.row(static_cast<Eigen::Index>(f)) =
        Eigen::Map<const Eigen::RowVectorXd>(moved.data(), moved.size());
  }
  return block;
}

void for_each_block(const FrameSource& frames, const Observer& observer,
                    const std::function<void(std::size_t part, const FrameBlock& block)>& work,
                    const std::function<void(std::size_t part)>& finish) {
  const std::vector<VertexRange> ranges = block_ranges(frames);
  for (std::size_t begin = 0; begin < ranges.size(); begin += kPartsAtOnce) {
    const std::size_t end = std::min(ranges.size(), begin + kPartsAtOnce);
    tbb::parallel_for(begin, end, [&](std::size_t part) {
      stop_if_cancelled(observer);
      work(part, read_block(frames, ranges[part]));
    });
    for (std::size_t part = begin; part < end; ++part) finish(part);
  }
}

std::vector<Eigen::Index> strays(const FrameSource& frames, const Deviation& deviation,
                                 double tolerance, const Observer& observer) {
  const std::vector<VertexRange> ranges = block_ranges(frames);
  using Stray =
      std::pair<double, Eigen::Index>;  // its distance below 0, so that the worst is least
  std::vector<std::vector<Stray>> of_part(ranges.size());
  std::vector<Stray> all;
  for_each_block(
      frames, observer,
      [&](std::size_t part, const FrameBlock& block) {
        const Eigen::VectorXd distances = deviation(block);
        std::vector<Stray>& worst = of_part[part];
        for (Eigen::Index v = 0; v < distances.size(); ++v) {
          if (distances(v) > tolerance) worst.emplace_back(-distances(v), ranges[part].first + v);
        }
        std::sort(worst.begin(), worst.end());
        worst.resize(std::min(worst.size(), kStraysAPart));
      },
      [&](std::size_t part) { all.insert(all.end(), of_part[part].begin(), of_part[part].end()); });
  std::sort(all.begin(), all.end());
  all.resize(std::min(all.size(), static_cast<std::size_t>(count_to_see(frames))));
  std::vector<Eigen::Index> vertices;
  for (const auto& [distance, vertex] : all) vertices.push_back(vertex);
  return vertices;
}

std::vector<Eigen::Index> spread_vertices(const FrameSource& frames) {
  const Eigen::Index step = std::max<Eigen::Index>(1, frames.vertex_count / count_to_see(frames));
  std::vector<Eigen::Index> vertices;
  for (Eigen::Index v = 0; v < frames.vertex_count; v += step) vertices.push_back(v);
  return vertices;
}

}  // namespace morphbake
