#include "morphbake/preview/motion_measures.h"

#include <fmt/core.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/gltf/morphed_rows.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/preview/motion.h"
#include "morphbake/sources/corner_surface.h"

namespace morphbake {
namespace {

constexpr std::size_t kTimesAtOnce = 8;  // in memory, whatever the number of threads
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// What a surface is at one moment.
struct Shape {
  double volume = 0;
  double area = 0;
  Eigen::VectorXd lengths;  ///< one an edge
  Eigen::VectorXd bends;    ///< likewise, degrees
  double tear = 0;
};

/// The frames that a motion is measured against.
struct MotionEnds {
  PlayedSpan span;
  Shape first;
  Shape last;
};

/// One number of each list of MotionMeasures.
struct MomentMeasures {
  double volume = 0;
  double volume_change = 0;
  double area = 0;
  double area_change = 0;
  double edge_length_change = 0;
  double bend_change = 0;
  double tear = 0;
};

double largest_tear(const FollowedSurface& surface, const Positions& render) {
  double largest = 0;
  for (std::size_t r = 0; r < surface.vertices_at.size(); ++r) {
    if (surface.vertices_at[r] < 0) continue;
    const int first = surface.render_of[static_cast<std::size_t>(surface.vertices_at[r])];
    const auto row = static_cast<Eigen::Index>(r);
    largest = std::max(largest, (render.row(row) - render.row(first)).norm());
  }
  return largest;
}

Shape shape_at(const AnimatedMesh& mesh, const FollowedSurface& surface, double time) {
  const Positions render = morphed_positions(mesh, weights_at(mesh, time));
  if (!render.allFinite()) {
    Problem problem;
    problem.code = "preview.not-finite";
    problem.message = fmt::format("at {:.4g} s a vertex is infinite or not a number", time);
    problem.hint = "check the morph targets and weights of the file";
    throw BakeError(std::move(problem));
  }
  const Positions positions = render(surface.render_of, Eigen::all);
  Shape shape;
  shape.volume = enclosed_volume(positions, surface.triangles);
  shape.area = triangle_areas(positions, surface.triangles).sum();
  shape.lengths = edge_lengths(positions, surface.edges);
  shape.bends = bend_angles(positions, surface.edges);
  shape.tear = largest_tear(surface, render);
  return shape;
}

double mixed(double first, double last, double share) { return first + share * (last - first); }

/// Root of the mean square of all values but NaN, in their order.
template <class ValueAt>
double root_mean_square(Eigen::Index count, const ValueAt& value_at) {
  double sum = 0;
  Eigen::Index counted = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double value = value_at(i);
    if (std::isnan(value)) continue;
    sum += value * value;
    ++counted;
  }
  return counted > 0 ? std::sqrt(sum / static_cast<double>(counted)) : kNone;
}

/// (now - expected) / first
double relative_change(double now, double first, double last, double share) {
  return first != 0 ? (now - mixed(first, last, share)) / first : kNone;
}

MomentMeasures measure_at(const AnimatedMesh& mesh, const FollowedSurface& surface,
                          const MotionEnds& ends, double time) {
  const auto& [span, first, last] = ends;
  const double length = span.end - span.begin;
  const double share = length > 0 ? std::clamp((time - span.begin) / length, 0.0, 1.0) : 0;
  const Shape shape = shape_at(mesh, surface, time);
  MomentMeasures measures;
  measures.tear = shape.tear;
  measures.volume = shape.volume;
  measures.volume_change = relative_change(shape.volume, first.volume, last.volume, share);
  measures.area = shape.area;
  measures.area_change = relative_change(shape.area, first.area, last.area, share);
  measures.edge_length_change = root_mean_square(shape.lengths.size(), [&](Eigen::Index e) {
    const double expected = mixed(ends.first.lengths(e), ends.last.lengths(e), share);
    return expected > 0 ? shape.lengths(e) / expected - 1 : kNone;
  });
  measures.bend_change = root_mean_square(shape.bends.size(), [&](Eigen::Index e) {
    const double expected = mixed(ends.first.bends(e), ends.last.bends(e), share);
    // Sharp folds lie at 180 and -180 degrees, which is one angle.
    return std::remainder(shape.bends(e) - expected, 360.0);
  });
  return measures;
}

void append(const MomentMeasures& moment, double time, bool has_volume, MotionMeasures& motion) {
  if (has_volume) {
    motion.volume.push_back(moment.volume);
    motion.volume_change.push_back(moment.volume_change);
  }
  motion.area.push_back(moment.area);
  motion.area_change.push_back(moment.area_change);
  motion.edge_length_change.push_back(moment.edge_length_change);
  motion.bend_change.push_back(moment.bend_change);
  if (moment.tear <= motion.largest_tear) return;
  motion.largest_tear = moment.tear;
  motion.tear_time = time;
}

}  // namespace

FollowedSurface follow_surface(const SourceMesh& source) {
  const CornerSurface corners = surface_of_corners(source, welded_corners(source));
  FollowedSurface surface;
  surface.triangles = corners.connectivity.triangles;
  surface.edges = surface_edges(surface.triangles);
  surface.vertices_at = vertices_of_render(source, corners);
  surface.render_of.assign(static_cast<std::size_t>(corners.connectivity.vertex_count), 0);
  for (std::size_t r = surface.vertices_at.size(); r-- > 0;) {
    const int vertex = surface.vertices_at[r];
    if (vertex >= 0) surface.render_of[static_cast<std::size_t>(vertex)] = static_cast<int>(r);
  }
  return surface;
}

MotionMeasures measure_motion(const AnimatedMesh& mesh, const FollowedSurface& surface,
                              const std::vector<double>& times, int threads,
                              const Observer& observer) {
  const PlayedSpan span = played_span(mesh);
  const MotionEnds ends{span, shape_at(mesh, surface, span.begin),
                        shape_at(mesh, surface, span.end)};
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(threads > 0 ? std::min(threads, cores) : cores);
  MotionMeasures motion;
  for (std::size_t begin = 0; begin < times.size(); begin += kTimesAtOnce) {
    std::vector<MomentMeasures> moments(std::min(kTimesAtOnce, times.size() - begin));
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, moments.size(), [&](std::size_t i) {
        moments[i] = measure_at(mesh, surface, ends, times[begin + i]);
      });
    });
    for (std::size_t i = 0; i < moments.size(); ++i) {
      append(moments[i], times[begin + i], surface.edges.is_closed, motion);
    }
    stop_if_cancelled(observer);
  }
  return motion;
}

int furthest_from_zero(const std::vector<double>& values) {
  int furthest = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    const auto at = static_cast<std::size_t>(furthest);
    if (furthest < 0 || std::abs(values[i]) > std::abs(values[at])) furthest = static_cast<int>(i);
  }
  return furthest;
}

}  // namespace morphbake
