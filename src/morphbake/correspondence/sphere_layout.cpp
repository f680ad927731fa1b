#include "morphbake/correspondence/sphere_layout.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kCoarse = 500;     // levels below this many vertices are cheap: relaxed longer
constexpr double kGrowth = 1.4;  // of the number of vertices between two relaxations
constexpr int kSweeps = 8;
constexpr int kCrowded = 64;  // neighbours from which a vertex waits for the next relaxation
constexpr int kStride = 256;  // vertices between two looks whether to stop

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// A triangle at the vertex that moves: its other corners, and its shape at rest.
struct StarTriangle {
  int a = 0;
  int b = 0;
  bool is_cap = false;  ///< may not turn either, but has no shape to keep
  RestTriangle rest;
};

/// What a moving vertex meets.
struct Star {
  std::vector<StarTriangle> triangles;
  bool has_target = false;
};

void gather_star(const SphereLayout& layout, int vertex, Star& star) {
  star.triangles.clear();
  const int apex = layout.surface->apex;
  layout.mesh.around(vertex, [&](int h) {
    StarTriangle& triangle = star.triangles.emplace_back();
    triangle.a = layout.mesh.to(h);
    triangle.b = layout.mesh.apex(h);
    triangle.is_cap = apex >= 0 && (vertex == apex || triangle.a == apex || triangle.b == apex);
    if (triangle.is_cap) return;
    triangle.rest =
        rest_triangle(layout.positions[index(vertex)], layout.positions[index(triangle.a)],
                      layout.positions[index(triangle.b)], layout.rest_scale, {});
  });
  star.has_target =
      layout.pull > 0 && !layout.targets.empty() && layout.targets[index(vertex)].squaredNorm() > 0;
}

double energy_at(const SphereLayout& layout, const Star& star, int vertex, const Vector3d& place) {
  double sum = 0;
  for (const StarTriangle& triangle : star.triangles) {
    const Vector3d &a = layout.sphere[index(triangle.a)], &b = layout.sphere[index(triangle.b)];
    if (!is_positive(place, a, b)) return kInfinity;
    if (!triangle.is_cap) sum += sphere_energy(triangle.rest, place, a, b);
  }
  if (star.has_target) {
    sum += layout.pull * (place - layout.targets[index(vertex)]).squaredNorm();
  }
  return sum;
}

CornerEnergy derivatives(const SphereLayout& layout, const Star& star, int vertex) {
  const Vector3d& place = layout.sphere[index(vertex)];
  CornerEnergy sum;
  for (const StarTriangle& triangle : star.triangles) {
    if (triangle.is_cap) continue;
    add_sphere_energy(triangle.rest, place, layout.sphere[index(triangle.a)],
                      layout.sphere[index(triangle.b)], sum);
  }
  if (star.has_target) {
    const Vector3d away = place - layout.targets[index(vertex)];
    sum.energy += layout.pull * away.squaredNorm();
    sum.gradient += 2 * layout.pull * away;
    sum.hessian += 2 * layout.pull * Eigen::Matrix3d::Identity();
  }
  return sum;
}

/// A step in the tangent plane (for boundary vertices along the equator) and how steep it falls.
struct Step {
  Vector3d direction = Vector3d::Zero();
  double slope = 0;
};

Step descent(const CornerEnergy& at, const Vector3d& place, bool on_boundary) {
  const double inward = at.gradient.dot(place);  // the sphere's curvature
  Step step;
  if (on_boundary) {
    const Vector3d along(-place.y(), place.x(), 0);
    const double gradient = at.gradient.dot(along);
    const double curvature = std::abs(along.dot(at.hessian * along) - inward);
    if (!(curvature > 0)) return step;
    step.direction = (-gradient / curvature) * along;
    step.slope = -gradient * gradient / curvature;
    return step;
  }
  const TangentAxes axes = tangent_axes(place);
  const Vector3d ha = at.hessian * axes.a, hb = at.hessian * axes.b;
  Eigen::Matrix2d hessian;
  hessian << axes.a.dot(ha) - inward, axes.a.dot(hb), axes.a.dot(hb), axes.b.dot(hb) - inward;
  const Vector2d gradient(at.gradient.dot(axes.a), at.gradient.dot(axes.b));
  const Vector2d newton = newton_step(gradient, hessian);
  step.direction = newton.x() * axes.a + newton.y() * axes.b;
  step.slope = gradient.dot(newton);
  return step;
}

/// One Newton step with a line search that no triangle survives turned.
void move(SphereLayout& layout, int vertex, Star& star) {
  if (layout.pinned[index(vertex)] || vertex == layout.surface->apex) return;
  gather_star(layout, vertex, star);
  const Vector3d place = layout.sphere[index(vertex)];
  const CornerEnergy at = derivatives(layout, star, vertex);
  const bool on_boundary = layout.surface->on_boundary[index(vertex)];
  Step step = descent(at, place, on_boundary);
  if (!(-step.slope > 1e-10 * at.energy)) return;
  const double longest = on_boundary ? 0.3 : 0.5;  // radians
  const double length = step.direction.norm();
  double share = std::min(1.0, longest / length);
  for (int halvings = 0; halvings < 24; ++halvings, share *= 0.5) {
    const Vector3d next = (place + share * step.direction).normalized();
    if (energy_at(layout, star, vertex, next) < at.energy + 1e-4 * share * step.slope) {
      layout.sphere[index(vertex)] = next;
      return;
    }
  }
}

double area_of(const SphereLayout& layout) {
  double area = 0;
  const ClosedMesh& mesh = layout.mesh;
  const int apex = layout.surface->apex;
  for (int f = 0; f < mesh.triangle_slots(); ++f) {
    if (!mesh.has_triangle(f)) continue;
    const int a = mesh.from(3 * f), b = mesh.from(3 * f + 1), c = mesh.from(3 * f + 2);
    if (apex >= 0 && (a == apex || b == apex || c == apex)) continue;
    area += 0.5 * (layout.positions[index(b)] - layout.positions[index(a)])
                      .cross(layout.positions[index(c)] - layout.positions[index(a)])
                      .norm();
  }
  return area;
}

/// Rest areas of the present level sum to the sphere's, or to the hemisphere's.
void set_rest_scale(SphereLayout& layout) {
  const double whole = (layout.surface->apex < 0 ? 4 : 2) * std::numbers::pi;
  layout.rest_scale = whole / std::max(area_of(layout), 1e-12);
}

double total_energy(const SphereLayout& layout) {
  double sum = 0;
  const ClosedMesh& mesh = layout.mesh;
  const int apex = layout.surface->apex;
  for (int f = 0; f < mesh.triangle_slots(); ++f) {
    if (!mesh.has_triangle(f)) continue;
    const int a = mesh.from(3 * f), b = mesh.from(3 * f + 1), c = mesh.from(3 * f + 2);
    if (apex >= 0 && (a == apex || b == apex || c == apex)) continue;
    const RestTriangle rest = rest_triangle(layout.positions[index(a)], layout.positions[index(b)],
                                            layout.positions[index(c)], layout.rest_scale, {});
    sum += sphere_energy(rest, layout.sphere[index(a)], layout.sphere[index(b)],
                         layout.sphere[index(c)]);
  }
  return sum;
}

/// Where a new boundary vertex may go: on the equator between its two neighbours there.
std::vector<Vector3d> equator_candidates(const SphereLayout& layout, int vertex, int parent) {
  std::vector<Vector3d> candidates;
  int other = -1;
  layout.mesh.around(vertex, [&](int h) {
    const int w = layout.mesh.to(h);
    if (w != parent && w != layout.surface->apex && layout.surface->on_boundary[index(w)])
      other = w;
  });
  const Vector3d &p = layout.sphere[index(parent)], &q = layout.sphere[index(other)];
  const double from = std::atan2(p.y(), p.x());
  const double short_way = std::remainder(std::atan2(q.y(), q.x()) - from, 2 * std::numbers::pi);
  const double long_way = short_way - std::copysign(2 * std::numbers::pi, short_way);
  for (const double way : {short_way, long_way}) {
    for (const double t : {0.5, 0.35, 0.2, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6}) {
      candidates.emplace_back(std::cos(from + t * way), std::sin(from + t * way), 0);
    }
  }
  return candidates;
}

/// The part of a polygon (counter-clockwise) where offset + normal . x >= 0.
std::vector<Vector2d> clipped(const std::vector<Vector2d>& polygon, double offset,
                              const Vector2d& normal) {
  std::vector<Vector2d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &x = polygon[i], &y = polygon[(i + 1) % polygon.size()];
    const double dx = offset + normal.dot(x), dy = offset + normal.dot(y);
    if (dx >= 0) kept.push_back(x);
    if ((dx < 0) != (dy < 0)) kept.push_back(x + dx / (dx - dy) * (y - x));
  }
  return kept;
}

Vector2d area_centroid(const std::vector<Vector2d>& polygon) {
  double area = 0;
  Vector2d sum = Vector2d::Zero();
  const Vector2d& o = polygon[0];
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vector2d x = polygon[i] - o, y = polygon[i + 1] - o;
    const double w = x.x() * y.y() - x.y() * y.x();
    area += w;
    sum += w / 3 * (x + y);
  }
  return area > 0 ? Vector2d(o + sum / area) : o;
}

/// Where a new inner vertex may go: from its parent towards the middle of the kernel of its ring,
/// the places that see all of it. The parent sees the whole ring, so the kernel is never empty.
std::vector<Vector3d> kernel_candidates(const SphereLayout& layout, int vertex, int parent) {
  const Vector3d& p = layout.sphere[index(parent)];
  const TangentAxes axes = tangent_axes(p);
  double radius = 0;
  layout.mesh.around(vertex, [&](int h) {
    radius = std::max(radius, (layout.sphere[index(layout.mesh.to(h))] - p).norm());
  });
  std::vector<Vector2d> kernel{{-4, -4}, {4, -4}, {4, 4}, {-4, 4}};  // in radii around p
  layout.mesh.around(vertex, [&](int h) {
    if (kernel.size() < 3) return;
    const int a = layout.mesh.to(h), b = layout.mesh.apex(h);
    const Vector3d &pa = layout.sphere[index(a)], &pb = layout.sphere[index(b)];
    const Vector3d normal = pa.cross(pb - pa);
    // The half-planes of the two edges at the parent go through it exactly.
    const double offset = a == parent || b == parent ? 0 : (pa - p).cross(pb - p).dot(p);
    kernel = clipped(kernel, offset, radius * Vector2d(normal.dot(axes.a), normal.dot(axes.b)));
  });
  std::vector<Vector3d> candidates;
  if (kernel.size() < 3) return candidates;
  const Vector2d middle = radius * area_centroid(kernel);
  for (const double t : {1.0, 0.7, 0.45, 0.25, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5}) {
    candidates.push_back((p + t * (middle.x() * axes.a + middle.y() * axes.b)).normalized());
  }
  return candidates;
}

void place_vertex(SphereLayout& layout, int vertex, int parent, Star& star) {
  const std::vector<Vector3d> candidates = layout.surface->on_boundary[index(vertex)]
                                               ? equator_candidates(layout, vertex, parent)
                                               : kernel_candidates(layout, vertex, parent);
  gather_star(layout, vertex, star);
  double best = kInfinity;
  for (const Vector3d& candidate : candidates) {
    const double energy = energy_at(layout, star, vertex, candidate);
    if (!(energy < best)) continue;
    best = energy;
    layout.sphere[index(vertex)] = candidate;
  }
  if (best < kInfinity) return;
  throw BakeError(
      Problem{Severity::Error,
              "correspondence.no-room",
              {},
              "the surface is too thin somewhere to be laid on a sphere in double precision",
              "remesh the source with more even triangles"});
}

}  // namespace

SphereLayout make_layout(const CappedSurface& surface) {
  const auto count = static_cast<std::size_t>(surface.positions.rows());
  SphereLayout layout{&surface,
                      std::vector<Vector3d>(count),
                      ClosedMesh(surface.triangles, static_cast<int>(count)),
                      {},
                      std::vector<Vector3d>(count, Vector3d::Zero()),
                      std::vector<char>(count, 0),
                      {},
                      0,
                      1};
  const Eigen::RowVector3d centre = surface.positions.colwise().mean();
  for (std::size_t v = 0; v < count; ++v) {
    layout.positions[v] = surface.positions.row(static_cast<Eigen::Index>(v)) - centre;
  }
  const double area = area_of(layout);
  const double scale = area > 0 ? 1 / std::sqrt(area) : 1;
  for (Vector3d& position : layout.positions) position *= scale;
  return layout;
}

void lie_down(SphereLayout& layout) {
  const ClosedMesh& mesh = layout.mesh;
  const int apex = layout.surface->apex;
  std::vector<int> living, boundary;
  for (int v = 0; v < mesh.vertex_slots(); ++v) {
    if (!mesh.has_vertex(v) || v == apex) continue;
    (layout.surface->on_boundary[index(v)] ? boundary : living).push_back(v);
  }
  if (apex < 0) {
    const std::array<Vector3d, 4> corners{Vector3d(1, 1, 1), Vector3d(-1, -1, 1),
                                          Vector3d(-1, 1, -1), Vector3d(1, -1, -1)};
    for (std::size_t i = 0; i < 4; ++i) layout.sphere[index(living[i])] = corners[i].normalized();
  } else {
    layout.sphere[index(apex)] = -Vector3d::UnitZ();
    layout.sphere[index(living[0])] = Vector3d::UnitZ();
    for (std::size_t i = 0; i < boundary.size(); ++i) {
      const double angle =
          2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(boundary.size());
      layout.sphere[index(boundary[i])] = {std::cos(angle), std::sin(angle), 0};
    }
  }
  int f = 0;
  while (!mesh.has_triangle(f)) ++f;
  const bool turned = determinant(layout.sphere[index(mesh.from(3 * f))],
                                  layout.sphere[index(mesh.from(3 * f + 1))],
                                  layout.sphere[index(mesh.from(3 * f + 2))]) < 0;
  if (!turned) return;
  for (Vector3d& place : layout.sphere) place.y() = -place.y();
}

double star_energy(const SphereLayout& layout, int vertex, const Vector3d& place) {
  Star star;
  gather_star(layout, vertex, star);
  return energy_at(layout, star, vertex, place);
}

void relax(SphereLayout& layout, int sweeps, const Observer& observer) {
  set_rest_scale(layout);
  std::vector<int> living;
  for (int v = 0; v < layout.mesh.vertex_slots(); ++v) {
    if (layout.mesh.has_vertex(v)) living.push_back(v);
  }
  Star star;
  double energy = total_energy(layout);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = 0; i < living.size(); ++i) {
      if (i % kStride == 0) stop_if_cancelled(observer);
      move(layout, living[i], star);
    }
    std::reverse(living.begin(), living.end());
    const double now = total_energy(layout);
    if (energy - now < 1e-4 * energy) return;
    energy = now;
  }
}

void refine(SphereLayout& layout, int count, const Observer& observer) {
  set_rest_scale(layout);
  const auto following = [&] { return static_cast<int>(kGrowth * layout.mesh.vertex_count()) + 1; };
  int next_level = following();
  Star star;
  std::vector<int> ring;
  while (layout.mesh.vertex_count() < count && !layout.collapses.empty()) {
    if (layout.collapses.size() % kStride == 0) stop_if_cancelled(observer);
    const CollapseRecord record = layout.collapses.back();
    layout.collapses.pop_back();
    layout.mesh.undo(record);
    place_vertex(layout, record.removed, record.kept, star);
    ring.clear();
    layout.mesh.around(record.removed, [&](int h) {
      const int v = layout.mesh.to(h);
      if (!layout.mesh.has_valence_above(v, kCrowded)) ring.push_back(v);
    });
    move(layout, record.removed, star);
    for (const int v : ring) move(layout, v, star);
    move(layout, record.removed, star);
    if (layout.mesh.vertex_count() < next_level && layout.mesh.vertex_count() != count) continue;
    relax(layout, layout.mesh.vertex_count() < kCoarse ? 4 * kSweeps : kSweeps, observer);
    next_level = following();
  }
}

}  // namespace morphbake
