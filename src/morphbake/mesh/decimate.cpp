#include "morphbake/mesh/decimate.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace morphbake {
namespace {

namespace simplification = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

Surface to_cgal(const Mesh& mesh) {
  Surface surface;
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
    surface.add_vertex(
        Kernel::Point_3(mesh.positions(v, 0), mesh.positions(v, 1), mesh.positions(v, 2)));
  }
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    const auto corner = [&](int k) {
      return Surface::Vertex_index(static_cast<unsigned>(mesh.triangles(f, k)));
    };
    surface.add_face(corner(0), corner(1), corner(2));
  }
  return surface;
}

Mesh from_cgal(Surface& surface) {
  surface.collect_garbage();
  Mesh mesh{Positions(surface.number_of_vertices(), 3), Triangles(surface.number_of_faces(), 3)};
  for (const auto v : surface.vertices()) {
    const auto& point = surface.point(v);
    mesh.positions.row(v.idx()) << point.x(), point.y(), point.z();
  }
  for (const auto f : surface.faces()) {
    int k = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) {
      mesh.triangles(f.idx(), k++) = static_cast<int>(v.idx());
    }
  }
  return mesh;
}

}  // namespace

Mesh decimated(const Mesh& mesh, int vertices) {
  if (mesh.positions.rows() <= vertices) return mesh;
  Surface surface = to_cgal(mesh);
  // Three edges a vertex, as on closed surfaces.
  const simplification::Count_stop_predicate<Surface> stop(static_cast<std::size_t>(vertices) * 3);
  using Policies = simplification::GarlandHeckbert_plane_policies<Surface, Kernel>;
  const Policies policies(surface);
  simplification::edge_collapse(
      surface, stop,
      CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  return from_cgal(surface);
}

}  // namespace morphbake
