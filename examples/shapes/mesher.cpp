// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/locate.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/tangential_relaxation.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/make_mesh_3.h>

#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

namespace shapes {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Labeled_mesh_domain_3<Kernel>>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index,
                                                        Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

// Labels of space. Behind the cut is a region of its own, so that the cut becomes a sharp edge of
// the complex and the kept surface is exactly the patch between outside and front.
constexpr int outside = 0;
constexpr int front = 1;
constexpr int behind = 2;

Vector vector(const auto& p) {
  return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

Point point(const Vector& v) { return {v.x(), v.y(), v.z()}; }

Kernel::Sphere_3 bounds(const Solid& solid) {
  Eigen::AlignedBox3d box;
  for (const Part& part : solid.parts) {
    if (const auto* l = std::get_if<Limb>(&part.form)) {
      box.extend(l->from).extend(l->to);
    } else if (!part.join.carve) {
      box.extend(std::get<Ball>(part.form).centre);
    }
  }
  const double radius = box.diagonal().norm() / 2 + 0.7;  // no ball reaches further than 0.6 m
  return {point(box.center()), radius * radius};
}

/// The curve in which the plane of the cut meets the surface; the first part's centre sees it all.
std::vector<Point> cut_contour(const Solid& solid) {
  constexpr int steps = 400;
  const Vector centre(0, std::get<Ball>(solid.parts.front().form).centre.y(), *solid.cut_z);
  std::vector<Point> contour;
  for (int i = 0; i < steps; ++i) {
    const double angle = 2 * std::numbers::pi * i / steps;
    const Vector direction(std::cos(angle), std::sin(angle), 0);
    double low = 0;
    double high = 1;
    while (high - low > 1e-9) {
      const double middle = (low + high) / 2;
      (field(solid, centre + middle * direction) < 0 ? low : high) = middle;
    }
    contour.push_back(point(centre + low * direction));
  }
  contour.push_back(contour.front());
  return contour;
}

/// CGAL's sizing field: bounds the radius of each facet's Delaunay ball.
struct FacetSize {
  using FT = Kernel::FT;
  using Point_3 = Point;  // NOLINT(readability-identifier-naming): CGAL asks for this name
  using Index = Domain::Index;

  const Solid* solid;

  FT operator()(const Point& p, int, const Index&) const {
    const Vector at = vector(p);
    const double unseen = solid->cut_z ? 3 * std::max(0.0, *solid->cut_z - at.z()) : 0;
    return 0.68 * edge_length(*solid, at) + unseen;
  }
};

Complex refine(const Solid& solid) {
  const auto label = [&solid](const Point& p) {
    const Vector at = vector(p);
    if (field(solid, at) >= 0) return outside;
    return solid.cut_z && at.z() < *solid.cut_z ? behind : front;
  };
  using namespace CGAL::parameters;
  Domain domain(std::function<int(const Point&)>(label), bounds(solid), 1e-6);
  if (solid.cut_z) {
    const std::vector<std::vector<Point>> curves{cut_contour(solid)};
    domain.add_features(curves.begin(), curves.end());
  }
  CGAL::get_default_random() = CGAL::Random(2003);
  const Criteria criteria(edge_size = 0.95 * solid.edge, facet_angle = 28,
                          facet_size = FacetSize{&solid}, facet_distance = 0.15 * solid.edge);
  // Three patches meet in the curve of a cut: asking for a manifold there would refine forever.
  return CGAL::make_mesh_3<Complex>(domain, criteria, no_perturb(), no_exude(),
                                    solid.cut_z ? non_manifold() : manifold());
}

/// The triangles between outside and front, turned to the outside.
SurfaceMesh extract(const Complex& complex) {
  SurfaceMesh mesh;
  std::map<Triangulation::Vertex_handle, SurfaceMesh::Vertex_index> index;
  const auto& triangulation = complex.triangulation();
  for (auto it = complex.facets_in_complex_begin(); it != complex.facets_in_complex_end(); ++it) {
    Complex::Facet facet = *it;
    if (complex.subdomain_index(facet.first) != front) facet = triangulation.mirror_facet(facet);
    const auto other = complex.subdomain_index(triangulation.mirror_facet(facet).first);
    if (complex.subdomain_index(facet.first) != front || other == front || other == behind)
      continue;
    std::array<SurfaceMesh::Vertex_index, 3> corner;
    std::array<Point, 3> at;
    for (int i = 0; i < 3; ++i) {
      const auto v = facet.first->vertex(Triangulation::vertex_triple_index(facet.second, i));
      at[static_cast<std::size_t>(i)] = v->point().point();
      const auto [entry, is_new] = index.try_emplace(v);
      if (is_new) entry->second = mesh.add_vertex(v->point().point());
      corner[static_cast<std::size_t>(i)] = entry->second;
    }
    const Point inside = facet.first->vertex(facet.second)->point().point();
    if (CGAL::orientation(at[0], at[1], at[2], inside) == CGAL::POSITIVE)
      std::swap(corner[0], corner[1]);
    if (mesh.add_face(corner[0], corner[1], corner[2]) == SurfaceMesh::null_face())
      throw std::runtime_error("the surface mesher made a surface that is not manifold");
  }
  return mesh;
}

void relax(SurfaceMesh& mesh, const Solid& solid) {
  constexpr int rounds = 4;  // more make triangles no better and wash out the finer sizes
  for (int round = 0; round < rounds; ++round) {
    pmp::tangential_relaxation(mesh.vertices(), mesh);
    for (const auto v : mesh.vertices()) {
      const Vector p = vector(mesh.point(v));
      mesh.point(v) = point(mesh.is_border(v) ? on_contour(solid, p) : on_surface(solid, p));
    }
  }
}

SurfaceMesh surface_mesh(const Mesh& mesh) {
  SurfaceMesh result;
  for (const auto& p : mesh.positions.rowwise()) result.add_vertex(Point(p[0], p[1], p[2]));
  for (const auto& t : mesh.triangles.rowwise()) {
    const auto v = [&t](int i) { return SurfaceMesh::Vertex_index(static_cast<unsigned>(t[i])); };
    result.add_face(v(0), v(1), v(2));
  }
  return result;
}

Mesh plain_mesh(const SurfaceMesh& mesh, const Solid& solid) {
  Mesh result;
  result.positions.resize(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
  result.triangles.resize(static_cast<Eigen::Index>(mesh.number_of_faces()), 3);
  for (const auto v : mesh.vertices())
    result.positions.row(static_cast<int>(v)) = vector(mesh.point(v)).transpose();
  for (const auto f : mesh.faces()) {
    int corner = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh))
      result.triangles(static_cast<int>(f), corner++) = static_cast<int>(v);
  }
  round_to_float(result.positions);
  result.colors.resize(result.positions.rows(), 3);
  for (Eigen::Index v = 0; v < result.positions.rows(); ++v)
    result.colors.row(v) = color(solid, result.positions.row(v).transpose()).transpose();
  return result;
}

}  // namespace

Mesh mesh_surface(const Solid& solid) {
  SurfaceMesh mesh = extract(refine(solid));
  relax(mesh, solid);
  return plain_mesh(mesh, solid);
}

void check(const Mesh& mesh, const std::string& name, Topology topology) {
  const auto require = [&name](bool holds, const std::string& what) {
    if (!holds) throw std::runtime_error(name + ": " + what);
  };
  SurfaceMesh surface = surface_mesh(mesh);
  require(static_cast<Eigen::Index>(surface.number_of_faces()) == mesh.triangles.rows(),
          "not manifold or not consistently oriented");
  const auto component = surface.add_property_map<SurfaceMesh::Face_index, std::size_t>().first;
  require(pmp::connected_components(surface, component) == 1, "not in one piece");
  for (const auto v : surface.vertices()) require(!surface.is_isolated(v), "has an unused vertex");
  const auto euler = static_cast<long>(surface.number_of_vertices()) -
                     static_cast<long>(surface.number_of_edges()) +
                     static_cast<long>(surface.number_of_faces());
  require(CGAL::is_closed(surface) == (topology == Topology::Sphere), "wrong boundary");
  require(euler == (topology == Topology::Sphere ? 2 : 1),
          "wrong genus: V - E + F is " + std::to_string(euler));
  std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> crossings;
  pmp::self_intersections(surface, std::back_inserter(crossings));
  for (const auto& [face, other] : crossings) {
    const Vector at = vector(surface.point(surface.target(surface.halfedge(face))));
    require(false, "intersects itself in " + std::to_string(crossings.size()) + " places, near " +
                       std::to_string(at.x()) + " " + std::to_string(at.y()) + " " +
                       std::to_string(at.z()));
  }
}

std::vector<SurfacePoint> closest(const Mesh& mesh, const std::vector<Vector>& points) {
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>;
  const SurfaceMesh surface = surface_mesh(mesh);
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
  pmp::build_AABB_tree(surface, tree);
  std::vector<SurfacePoint> result;
  for (const Vector& p : points) {
    const auto [face, weights] = pmp::locate_with_AABB_tree(point(p), tree, surface);
    // CGAL counts corners from the target of the face's halfedge, which add_face may rotate.
    SurfacePoint at{static_cast<int>(face), Vector::Zero()};
    auto h = surface.halfedge(face);
    for (std::size_t i = 0; i < 3; ++i, h = surface.next(h)) {
      for (int corner = 0; corner < 3; ++corner)
        if (mesh.triangles(at.triangle, corner) == static_cast<int>(surface.source(h)))
          at.barycentric[corner] = weights[i];
    }
    result.push_back(at);
  }
  return result;
}

}  // namespace shapes
