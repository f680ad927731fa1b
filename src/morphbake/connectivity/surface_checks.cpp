#include "morphbake/connectivity/surface_checks.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "morphbake/connectivity/polled_points.h"
#include "morphbake/mesh/closest_point.h"

namespace morphbake {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

Point point_of(const Positions& positions, int v) {
  return {positions(v, 0), positions(v, 1), positions(v, 2)};
}

Surface to_cgal(const Mesh& mesh) {
  Surface surface;
  for (int v = 0; v < mesh.positions.rows(); ++v) surface.add_vertex(point_of(mesh.positions, v));
  // Not add_face, which looks around each vertex every time: for ever at the hub of a large fan.
  std::vector<std::array<Surface::Vertex_index, 3>> faces;
  for (const auto& corners : mesh.triangles.rowwise()) {
    auto& face = faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      face[k] = Surface::Vertex_index(static_cast<unsigned>(corners(static_cast<Eigen::Index>(k))));
    }
  }
  CGAL::Euler::add_faces(faces, surface);
  return surface;
}

Eigen::RowVector3d area_normal(const Mesh& mesh, int triangle) {
  const auto corner = [&](int k) -> Eigen::RowVector3d {
    return mesh.positions.row(mesh.triangles(triangle, k));
  };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

/// The source's triangle nearest to the middle of each of some triangles.
std::vector<int> triangles_below(const Mesh& source, const Mesh& remesh,
                                 const std::vector<int>& triangles, const Observer& observer) {
  Positions middles = Positions::Zero(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const int v : remesh.triangles.row(triangles[i])) {
      middles.row(static_cast<Eigen::Index>(i)) += remesh.positions.row(v) / 3;
    }
  }
  std::vector<int> below;
  if (triangles.empty()) return below;
  for (const SurfacePoint& point : closest_points(source, middles, observer)) {
    below.push_back(point.triangle);
  }
  return below;
}

}  // namespace

double hausdorff_distance(const Mesh& from, const Mesh& to, double error_bound,
                          const Observer& observer) {
  namespace parameters = CGAL::parameters;
  Surface a = to_cgal(from), b = to_cgal(to);
  Poll poll(observer);
  return CGAL::Polygon_mesh_processing::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(
      a, b, error_bound, parameters::vertex_point_map(PolledPoints(a, poll)),
      parameters::vertex_point_map(PolledPoints(b, poll)));
}

std::vector<int> folded_triangles(const Mesh& source, const Mesh& remesh,
                                  const std::vector<SurfacePoint>& on_source,
                                  const Observer& observer) {
  std::vector<int> suspects;
  for (int f = 0; f < remesh.triangles.rows(); ++f) {
    Eigen::RowVector3d at_corners = Eigen::RowVector3d::Zero();
    for (const int v : remesh.triangles.row(f)) {
      const int triangle = on_source[static_cast<std::size_t>(v)].triangle;
      at_corners += area_normal(source, triangle).normalized();
    }
    if (area_normal(remesh, f).dot(at_corners) < 0) suspects.push_back(f);
  }
  const std::vector<int> below = triangles_below(source, remesh, suspects, observer);
  std::vector<int> folded;
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    const Eigen::RowVector3d normal = area_normal(remesh, suspects[i]);
    if (normal.dot(area_normal(source, below[i])) < 0) folded.push_back(suspects[i]);
  }
  return folded;
}

std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, const Observer& observer) {
  Surface surface = to_cgal(mesh);
  Poll poll(observer);
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(
      surface, std::back_inserter(found),
      CGAL::parameters::vertex_point_map(PolledPoints(surface, poll))
          .maximum_number(static_cast<std::size_t>(kMostSelfIntersections)));
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [f, g] : found) {
    pairs.emplace_back(static_cast<int>(f.idx()), static_cast<int>(g.idx()));
  }
  return pairs;
}

std::vector<char> triangles_near_cuts(const Mesh& mesh, const Observer& observer) {
  std::vector<char> is_corner(static_cast<std::size_t>(mesh.positions.rows()), 0);
  const auto mark = [&](int triangle) {
    for (const int v : mesh.triangles.row(triangle)) is_corner[static_cast<std::size_t>(v)] = 1;
  };
  for (const auto& [f, g] : self_intersections(mesh, observer)) {
    mark(f);
    mark(g);
  }
  std::vector<char> is_near;
  for (const auto& triangle : mesh.triangles.rowwise()) {
    is_near.push_back(std::any_of(triangle.begin(), triangle.end(), [&](int v) {
      return is_corner[static_cast<std::size_t>(v)] != 0;
    }));
  }
  return is_near;
}

std::vector<std::pair<int, int>> new_cuts(const std::vector<std::pair<int, int>>& pairs,
                                          const Mesh& remesh, const Mesh& source,
                                          const std::vector<char>& near_cuts) {
  std::vector<int> triangles;  // each once: a tangled surface has many pairs of each
  for (const auto& [f, g] : pairs) triangles.insert(triangles.end(), {f, g});
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  const std::vector<int> below = triangles_below(source, remesh, triangles, {});
  std::vector<char> is_near(static_cast<std::size_t>(remesh.triangles.rows()), 0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    is_near[static_cast<std::size_t>(triangles[i])] = near_cuts[static_cast<std::size_t>(below[i])];
  }
  std::vector<std::pair<int, int>> found;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(found), [&](const auto& pair) {
    return !is_near[static_cast<std::size_t>(pair.first)] ||
           !is_near[static_cast<std::size_t>(pair.second)];
  });
  return found;
}

}  // namespace morphbake
