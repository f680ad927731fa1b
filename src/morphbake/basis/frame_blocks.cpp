#include "morphbake/basis/frame_blocks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace morphbake {
namespace {

constexpr double kBlockBytes = 8e6;
constexpr std::size_t kPartsAtOnce = 8;   // in memory, whatever the number of threads
constexpr std::size_t kStraysAPart = 16;  // more would be neighbours of these
constexpr Eigen::Index kSpreadCount = 1000;

}  // namespace

std::vector<VertexRange> block_ranges(const FrameSource& frames) {
  const double bytes_a_vertex = 3 * sizeof(double) * static_cast<double>(frames.times.size());
  const auto length =
      static_cast<Eigen::Index>(std::clamp(kBlockBytes / bytes_a_vertex, 16.0, 8192.0));
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
  std::vector<std::vector<Eigen::Index>> of_part(ranges.size());
  std::vector<Eigen::Index> all;
  for_each_block(
      frames, observer,
      [&](std::size_t part, const FrameBlock& block) {
        const Eigen::VectorXd distances = deviation(block);
        std::vector<Eigen::Index>& worst = of_part[part];
        for (Eigen::Index v = 0; v < distances.size(); ++v) {
          if (distances(v) > tolerance) worst.push_back(v);
        }
        const auto farther = [&](Eigen::Index a, Eigen::Index b) {
          return distances(a) != distances(b) ? distances(a) > distances(b) : a < b;
        };
        std::sort(worst.begin(), worst.end(), farther);
        worst.resize(std::min(worst.size(), kStraysAPart));
      },
      [&](std::size_t part) {
        for (const Eigen::Index v : of_part[part]) all.push_back(ranges[part].first + v);
      });
  return all;
}

std::vector<Eigen::Index> spread_vertices(const FrameSource& frames) {
  const Eigen::Index step = std::max<Eigen::Index>(1, frames.vertex_count / kSpreadCount);
  std::vector<Eigen::Index> vertices;
  for (Eigen::Index v = 0; v < frames.vertex_count; v += step) vertices.push_back(v);
  return vertices;
}

}  // namespace morphbake
