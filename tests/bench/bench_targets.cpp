// Frames become few targets.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/timing.h"
#include "morphbake/basis/morph_basis.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

/// A plane of a fifth of the height that sweeps from below to above, all frames in memory.
std::vector<Positions> sweep(const Mesh& mesh, int frames) {
  const Positions bent = test::bent(mesh.positions, 0.3, 7);
  const double low = mesh.positions.col(0).minCoeff(), high = mesh.positions.col(0).maxCoeff();
  const double width = 0.2 * (high - low);
  std::vector<Positions> all;
  for (int f = 0; f < frames; ++f) {
    const double at = low - width + (high - low + 2 * width) * f / (frames - 1);
    const Eigen::ArrayXd share =
        ((at - mesh.positions.col(0).array()) / width + 0.5).cwiseMax(0).cwiseMin(1);
    const Eigen::ArrayXd soft = share * share * (3 - 2 * share);
    all.push_back(mesh.positions + Positions(soft.matrix().asDiagonal() * (bent - mesh.positions)));
  }
  return all;
}

}  // namespace

void bench_targets(int vertices, int frames, Figures& figures) {
  const std::string group =
      fmt::format("targets, {} frames of {} vertices", frames, shown_count(vertices));
  const int side = static_cast<int>(std::sqrt(vertices / 2.0));
  const Mesh mesh = test::torus(2 * side, side);
  const std::vector<Positions> all = sweep(mesh, frames);
  FrameSource source;
  source.vertex_count = mesh.positions.rows();
  for (int f = 0; f < frames; ++f) source.times.push_back(f / 30.0);
  source.rows = [&all](const FramePart& part) -> Positions {
    return all[part.frame].middleRows(part.first, part.count);
  };
  const double tolerance = 1e-3 * bounding_diagonal(mesh.positions);
  const std::vector<Clip> clips = {{"all", 0, source.times.back()}};
  const Observer nobody;
  std::size_t keyframes = 0, shapes = 0;
  double sum = 0;
  const auto read_all = [&] {
    for (const Positions& frame : all) sum += frame.sum();
  };
  const Pair principal = time_pair(3, read_all, [&] {
    shapes = principal_basis(source, tolerance, clips, nobody).targets.size();
  });
  const Pair key = time_pair(3, read_all, [&] {
    keyframes = keyframe_basis(source, tolerance, clips, nobody).targets.size();
  });
  figures.push_back(
      {group, "reading all frames once", principal.first, "s", sum != 0 ? "one thread" : ""});
  figures.push_back({group, "basis", principal.second, "s", fmt::format("{} targets", shapes)});
  figures.push_back({group, "basis / reading", principal.ratio, "x", "pairs"});
  figures.push_back({group, "keyframes", key.second, "s", fmt::format("{} targets", keyframes)});
  figures.push_back({group, "keyframes / reading", key.ratio, "x", "pairs"});
}

}  // namespace morphbake::bench
