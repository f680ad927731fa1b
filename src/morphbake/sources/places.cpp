#include "morphbake/sources/places.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "morphbake/json/json.h"
#include "morphbake/json/nearest.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

constexpr double kFar = 0.1;         // of the diagonal: the position is of another mesh
constexpr double kOff = 0.01;        // of the diagonal: worth a warning
constexpr double kSamePoint = 1e-6;  // of the diagonal

std::string shown_point(const Eigen::Vector3d& point) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", point.x(), point.y(), point.z());
}

Problem out_of_range(const char* kind, int index, Eigen::Index count, const Location& location) {
  return {
      Severity::Error, "landmarks.out-of-range", location,
      fmt::format("there is no {} {}: the mesh has {}", kind, index, count),
      fmt::format("the first is 0, the last {}; they are counted over all primitives", count - 1)};
}

/// The problem of a place that the file does not have; nothing to say otherwise.
std::vector<Problem> range_problems(const SourceMesh& source, const Place& place,
                                    const Location& location) {
  if (const auto* at = std::get_if<VertexPlace>(&place)) {
    if (at->vertex < source.positions.rows()) return {};
    return {out_of_range("vertex", at->vertex, source.positions.rows(), location)};
  }
  const auto* at = std::get_if<TrianglePlace>(&place);
  if (at == nullptr || at->triangle < source.triangles.rows()) return {};
  return {out_of_range("face", at->triangle, source.triangles.rows(), location)};
}

/// What finding the landmarks of one source needs, and what it finds.
struct Placement {
  const SourceMesh& source;
  const CornerSurface& surface;
  const Mesh& mesh;
  const SourceRef& ref;
  const Observer& observer;
  double diagonal = 0;
  std::vector<int> corner_of_vertex;    ///< #V: a corner of the surface, made when first needed
  std::vector<int> surface_triangle;    ///< #triangles of the file: -1 for dropped ones, likewise
  std::vector<SurfacePoint> positions;  ///< one a landmark that is a position, in their order
  std::vector<Problem> problems;
};

Location location_of(const Placement& placement, const Landmark& landmark) {
  const Location& all = placement.ref.landmarks_at;
  return {all.file, child_pointer(all.pointer, landmark.name)};
}

void complain(Placement& placement, const Landmark& landmark, const char* code, std::string message,
              std::string hint) {
  placement.problems.push_back({Severity::Error, code, location_of(placement, landmark),
                                std::move(message), std::move(hint)});
}

/// The closest points of all landmarks that are positions, by one search tree.
std::vector<SurfacePoint> closest_to_positions(const Mesh& mesh,
                                               const std::vector<Landmark>& landmarks) {
  Positions wanted(static_cast<Eigen::Index>(landmarks.size()), 3);
  Eigen::Index count = 0;
  for (const Landmark& landmark : landmarks) {
    const auto* position = std::get_if<Eigen::Vector3d>(&landmark.at);
    if (position != nullptr) wanted.row(count++) = position->transpose();
  }
  if (count == 0) return {};
  return closest_points(mesh, wanted.topRows(count));
}

std::string off_surface(const std::string& source, const Eigen::Vector3d& wanted,
                        const Eigen::Vector3d& found, double share) {
  return fmt::format(
      "{} is {:.3g} % of the diagonal away from the surface of \"{}\"; the closest point is {}",
      shown_point(wanted), 100 * share, source, shown_point(found));
}

void check_distance(Placement& placement, const Landmark& landmark, const SurfacePoint& point) {
  const auto& wanted = std::get<Eigen::Vector3d>(landmark.at);
  const Eigen::Vector3d found = position_of(placement.mesh, point);
  const double share = placement.diagonal > 0 ? (wanted - found).norm() / placement.diagonal : 0.0;
  if (share <= kOff) return;
  const std::string message = off_surface(placement.source.name, wanted, found, share);
  if (share > kFar) {
    complain(placement, landmark, "landmarks.off-surface", message,
             "is this the landmark file of another mesh, or of another scale?");
    return;
  }
  report(placement.observer,
         Problem{Severity::Warning, "landmarks.off-surface", location_of(placement, landmark),
                 message, "the closest point is taken"});
}

SurfacePoint point_of_vertex(Placement& placement, const Landmark& landmark, int render) {
  const Triangles& triangles = placement.mesh.triangles;
  if (placement.corner_of_vertex.empty()) {
    placement.corner_of_vertex.assign(static_cast<std::size_t>(placement.mesh.positions.rows()),
                                      -1);
    for (Eigen::Index c = triangles.size() - 1; c >= 0; --c) {
      placement.corner_of_vertex[static_cast<std::size_t>(triangles.data()[c])] =
          static_cast<int>(c);
    }
  }
  const Triangles& in_file = placement.source.triangles;
  for (std::size_t c = 0; c < placement.surface.vertex_of_corner.size(); ++c) {
    const int vertex = placement.surface.vertex_of_corner[c];
    if (in_file.data()[c] != render || vertex < 0) continue;
    const int corner = placement.corner_of_vertex[static_cast<std::size_t>(vertex)];
    return {corner / 3, Eigen::Vector3d::Unit(corner % 3)};
  }
  complain(placement, landmark, "landmarks.unused-vertex",
           fmt::format("no triangle of \"{}\" uses vertex {}", placement.source.name, render),
           "choose a vertex of the surface, or give a position");
  return {};
}

SurfacePoint point_of_triangle(Placement& placement, const Landmark& landmark,
                               const TrianglePlace& place) {
  const CornerSurface& surface = placement.surface;
  if (placement.surface_triangle.empty()) {
    placement.surface_triangle.assign(static_cast<std::size_t>(placement.source.triangles.rows()),
                                      -1);
    for (std::size_t c = 0; c < surface.file_corner.size(); c += 3) {
      placement.surface_triangle[static_cast<std::size_t>(surface.file_corner[c] / 3)] =
          static_cast<int>(c / 3);
    }
  }
  const int triangle = placement.surface_triangle[static_cast<std::size_t>(place.triangle)];
  if (triangle < 0) {
    complain(placement, landmark, "landmarks.dropped-face",
             fmt::format("face {} of \"{}\" is no part of its surface: two of its corners lie at "
                         "one point, or an earlier face has the same corners",
                         place.triangle, placement.source.name),
             "choose a face beside it, or give a position");
    return {};
  }
  SurfacePoint point{triangle, {}};
  const auto corners = surface.file_corner.begin() + 3 * triangle;
  for (int k = 0; k < 3; ++k) point.barycentric(k) = place.barycentric(corners[k] % 3);
  point.barycentric /= point.barycentric.sum();
  return point;
}

/// Landmarks at one point, each such point once; sorted along x, only neighbours can be.
std::vector<std::vector<std::size_t>> shared_points(const std::vector<Eigen::Vector3d>& positions,
                                                    double nearest) {
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(positions[a].x(), a) < std::pair(positions[b].x(), b);
  });
  std::vector<std::vector<std::size_t>> groups;
  std::vector<char> is_told(positions.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (is_told[order[i]] != 0) continue;
    std::vector<std::size_t> group = {order[i]};
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Eigen::Vector3d apart = positions[order[j]] - positions[order[i]];
      if (apart.x() > nearest) break;
      if (apart.norm() > nearest || is_told[order[j]] != 0) continue;
      is_told[order[j]] = 1;
      group.push_back(order[j]);
    }
    if (group.size() < 2) continue;
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

void check_same_points(Placement& placement, const std::vector<SurfacePoint>& points) {
  std::vector<Eigen::Vector3d> positions;
  for (const SurfacePoint& point : points) positions.push_back(position_of(placement.mesh, point));
  const auto& landmarks = placement.ref.landmarks;
  for (const auto& group : shared_points(positions, kSamePoint * placement.diagonal)) {
    std::vector<std::string> names;
    for (const std::size_t each : group) names.push_back(shown(Json(landmarks[each].name)));
    const std::string last = names.back();
    names.pop_back();
    complain(placement, landmarks[group.back()], "landmarks.same-point",
             fmt::format("{} and {} lie at one point of \"{}\"", name_list(names), last,
                         placement.source.name),
             names.size() == 1 ? "move or remove one of them" : "move or remove all but one");
  }
}

}  // namespace

Eigen::Vector3d scene_position(const SourceMesh& source, const Place& place,
                               const Location& location) {
  std::vector<Problem> problems = range_problems(source, place, location);
  if (!problems.empty()) throw BakeError(std::move(problems));
  if (const auto* position = std::get_if<Eigen::Vector3d>(&place)) return *position;
  if (const auto* at = std::get_if<VertexPlace>(&place)) return source.positions.row(at->vertex);
  const auto& at = std::get<TrianglePlace>(place);
  return position_of({source.positions, source.triangles},
                     {at.triangle, at.barycentric / at.barycentric.sum()});
}

void check_near_surface(const SourceMesh& source, const Eigen::Vector3d& position,
                        const Location& location) {
  const double reach = kFar * bounding_diagonal(source.positions);
  const auto distances = (source.positions.rowwise() - position.transpose()).rowwise().norm();
  if (!(distances.minCoeff() > reach)) return;  // as a rule; the search below takes longer
  const std::vector<int> proper = triangles_with_area(source.positions, source.triangles);
  if (proper.empty()) return;
  const Mesh surface{source.positions, source.triangles(proper, Eigen::all)};
  const Eigen::Vector3d found = position_of(surface, closest_point(surface, position));
  const double away = (position - found).norm();
  if (away <= reach) return;
  throw BakeError(Problem{Severity::Error, "landmarks.off-surface", location,
                          off_surface(source.name, position, found, kFar * away / reach),
                          "is this a point of another mesh, or of another scale?"});
}

std::vector<SurfacePoint> landmark_points(const SourceMesh& source, const CornerSurface& surface,
                                          const Mesh& mesh, const SourceRef& ref,
                                          const Observer& observer) {
  Placement placement{source, surface, mesh, ref, observer, bounding_diagonal(mesh.positions),
                      {},     {},      {},   {}};
  placement.positions = closest_to_positions(mesh, ref.landmarks);
  std::vector<SurfacePoint> points;
  std::size_t next_position = 0;
  for (const Landmark& landmark : ref.landmarks) {
    SurfacePoint& point = points.emplace_back();
    const auto problems = range_problems(source, landmark.at, location_of(placement, landmark));
    placement.problems.insert(placement.problems.end(), problems.begin(), problems.end());
    if (!problems.empty()) continue;
    if (const auto* at = std::get_if<VertexPlace>(&landmark.at)) {
      point = point_of_vertex(placement, landmark, at->vertex);
    } else if (const auto* triangle = std::get_if<TrianglePlace>(&landmark.at)) {
      point = point_of_triangle(placement, landmark, *triangle);
    } else {
      point = placement.positions[next_position++];
      check_distance(placement, landmark, point);
    }
  }
  // Landmarks that could not be placed would all seem to lie at one point.
  if (placement.problems.empty()) check_same_points(placement, points);
  if (!placement.problems.empty()) throw BakeError(std::move(placement.problems));
  return points;
}

}  // namespace morphbake
