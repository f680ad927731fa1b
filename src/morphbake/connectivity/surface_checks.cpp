#include "morphbake/connectivity/surface_checks.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
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

std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh) {
  const Surface surface = to_cgal(mesh);
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(
      surface, std::back_inserter(found));
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [f, g] : found) {
    pairs.emplace_back(static_cast<int>(f.idx()), static_cast<int>(g.idx()));
  }
  return pairs;
}

std::vector<char> triangles_near_cuts(const Mesh& mesh) {
  std::vector<char> is_corner(static_cast<std::size_t>(mesh.positions.rows()), 0);
  const auto mark = [&](int triangle) {
    for (const int v : mesh.triangles.row(triangle)) is_corner[static_cast<std::size_t>(v)] = 1;
  };
  for (const auto& [f, g] : self_intersections(mesh)) {
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

}  // namespace morphbake
