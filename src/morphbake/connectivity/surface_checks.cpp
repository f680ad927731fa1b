#include "morphbake/connectivity/surface_checks.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

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
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    const auto corner = [&](int k) {
      return Surface::Vertex_index(static_cast<unsigned>(mesh.triangles(f, k)));
    };
    surface.add_face(corner(0), corner(1), corner(2));
  }
  return surface;
}

}  // namespace

double hausdorff_distance(const Mesh& from, const Mesh& to, double error_bound) {
  return CGAL::Polygon_mesh_processing::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(
      to_cgal(from), to_cgal(to), error_bound);
}

int count_self_intersections(const Mesh& mesh) {
  const Surface surface = to_cgal(mesh);
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(
      surface, std::back_inserter(pairs));
  return static_cast<int>(pairs.size());
}

int count_flipped(const Positions& sphere, const Triangles& triangles) {
  const Point origin(0, 0, 0);
  int count = 0;
  for (int f = 0; f < triangles.rows(); ++f) {
    // The sign of det(a, b, c), as for a triangle that is counter-clockwise from outside.
    const auto turn =
        CGAL::orientation(origin, point_of(sphere, triangles(f, 0)),
                          point_of(sphere, triangles(f, 1)), point_of(sphere, triangles(f, 2)));
    count += turn != CGAL::POSITIVE;
  }
  return count;
}

double solid_angle(const Positions& sphere, const Triangles& triangles) {
  double sum = 0;
  for (int f = 0; f < triangles.rows(); ++f) {
    const Eigen::Vector3d a = sphere.row(triangles(f, 0));
    const Eigen::Vector3d b = sphere.row(triangles(f, 1));
    const Eigen::Vector3d c = sphere.row(triangles(f, 2));
    // van Oosterom and Strackee 1983
    sum += 2 * std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return sum;
}

}  // namespace morphbake
