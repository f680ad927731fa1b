#include "morphbake/atlas/flatten_chart.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

// As-rigid-as-possible maps (CGAL's ARAP_parameterizer_3, 20 steps) took 8.3 s for 59,488 triangles
// in 4 charts where these take 0.7 s: it factorises anew in each step. Charts are flat enough for
// conformal ones: a cap of 60 degrees, the most bent there is, is scaled between 0.85 and 1.15.

namespace morphbake {
namespace {

namespace smp = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Simple_cartesian<double>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using PlaceMap = SurfaceMesh::Property_map<Vertex, Kernel::Point_2>;
using ExactPoint = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;

constexpr double kMostStretch = 2;        // of lengths, or its inverse ...
constexpr double kStretchedShare = 0.02;  // ... but for this share of the area, at most
constexpr double kMostScale = 2;          // of the mean length in any triangle, or its inverse

/// Corners of a triangle in its own plane, the first at the origin; columns are corners 1 and 2.
Eigen::Matrix2d own_plane(const Mesh& mesh, int triangle) {
  const auto corner = [&](int k) {
    return Eigen::Vector3d(mesh.positions.row(mesh.triangles(triangle, k)).transpose());
  };
  const Eigen::Vector3d a = corner(1) - corner(0), b = corner(2) - corner(0);
  const double length = a.norm();
  Eigen::Matrix2d plane = Eigen::Matrix2d::Zero();
  if (length == 0) {
    plane(0, 1) = b.norm();
    return plane;
  }
  plane << length, a.dot(b) / length, 0, a.cross(b).norm() / length;
  return plane;
}

FlatChart single_triangle(const Mesh& mesh, int triangle) {
  FlatChart chart{{triangle}, {0, 1, 2}, PicturePlaces::Zero(3, 2)};
  chart.places.bottomRows<2>() = own_plane(mesh, triangle).transpose();
  return chart;
}

/// The chart without its places, and the vertex of each row.
FlatChart numbered_chart(const Mesh& mesh, const std::vector<int>& triangles,
                         std::vector<int>& vertices) {
  FlatChart chart;
  chart.triangles = triangles;
  std::map<int, int> number;
  for (const int f : triangles) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles(f, k);
      const auto [entry, is_new] = number.try_emplace(vertex, static_cast<int>(vertices.size()));
      if (is_new) vertices.push_back(vertex);
      chart.of_corner.push_back(entry->second);
    }
  }
  return chart;
}

/// The chart by itself, of area 1, so that nothing depends on its unit.
SurfaceMesh cgal_mesh(const Mesh& mesh, const FlatChart& chart, const std::vector<int>& vertices) {
  double area = 0;
  for (const int f : chart.triangles) area += own_plane(mesh, f).determinant() / 2;
  const double scale = 1 / std::sqrt(area);
  SurfaceMesh surface;
  for (const int v : vertices) {
    const Eigen::RowVector3d at = scale * mesh.positions.row(v);
    surface.add_vertex({at(0), at(1), at(2)});
  }
  for (std::size_t f = 0; f < chart.triangles.size(); ++f) {
    const auto corner = [&](std::size_t k) {
      return Vertex(static_cast<SurfaceMesh::size_type>(chart.of_corner[3 * f + k]));
    };
    surface.add_face(corner(0), corner(1), corner(2));
  }
  return surface;
}

/// A halfedge of the border, of which a disk has one.
Halfedge border_of(const SurfaceMesh& surface) {
  for (const Halfedge h : surface.halfedges()) {
    if (surface.is_border(h)) return h;
  }
  return SurfaceMesh::null_halfedge();
}

/// Stretch of a triangle: columns of both are its corners 1 and 2 from corner 0.
bool is_stretched(const Eigen::Matrix2d& surface, const Eigen::Matrix2d& flat) {
  const Eigen::Matrix2d map = flat * surface.inverse();
  const Eigen::Vector2d stretches = Eigen::JacobiSVD<Eigen::Matrix2d>(map).singularValues();
  return !(stretches(0) <= kMostStretch) || !(stretches(1) >= 1 / kMostStretch);
}

Eigen::Matrix2d flat_corners(const FlatChart& chart, std::size_t f) {
  const auto place = [&](std::size_t k) {
    return Eigen::Vector2d(chart.places.row(chart.of_corner[3 * f + k]).transpose());
  };
  Eigen::Matrix2d corners;
  corners << place(1) - place(0), place(2) - place(0);
  return corners;
}

/// Makes the chart's area that of the surface. False when there is none, or a triangle is turned
/// over.
bool scale_to_surface(const Mesh& mesh, FlatChart& chart) {
  double surface = 0, flat = 0;
  for (std::size_t f = 0; f < chart.triangles.size(); ++f) {
    const double area = flat_corners(chart, f).determinant();
    if (!(area > 0)) return false;
    flat += area;
    surface += own_plane(mesh, chart.triangles[f]).determinant();
  }
  if (!(surface > 0)) return false;
  chart.places *= std::sqrt(surface / flat);
  return chart.places.allFinite();
}

bool keeps_lengths(const Mesh& mesh, const FlatChart& chart) {
  double all = 0, stretched = 0;
  for (std::size_t f = 0; f < chart.triangles.size(); ++f) {
    const Eigen::Matrix2d surface = own_plane(mesh, chart.triangles[f]);
    const Eigen::Matrix2d flat = flat_corners(chart, f);
    const double scale = std::sqrt(flat.determinant() / surface.determinant());
    if (!(scale <= kMostScale) || !(scale >= 1 / kMostScale)) return false;
    all += surface.determinant();
    if (is_stretched(surface, flat)) stretched += surface.determinant();
  }
  return stretched <= kStretchedShare * all;
}

/// A disk none of whose triangles is turned over lies side by side exactly when its border does not
/// cross itself.
bool has_simple_border(const SurfaceMesh& surface, Halfedge border, const FlatChart& chart) {
  std::vector<ExactPoint> polygon;
  for (const Halfedge h : CGAL::halfedges_around_face(border, surface)) {
    const auto place = chart.places.row(static_cast<Eigen::Index>(surface.target(h).idx()));
    polygon.emplace_back(place(0), place(1));
  }
  return CGAL::is_simple_2(polygon.begin(), polygon.end());
}

}  // namespace

std::optional<FlatChart> flatten_chart(const Mesh& mesh, const std::vector<int>& triangles) {
  if (triangles.size() == 1) return single_triangle(mesh, triangles.front());
  for (const int f : triangles) {
    if (!(own_plane(mesh, f).determinant() > 0)) return {};  // cotangents would be infinite
  }
  std::vector<int> vertices;
  FlatChart chart = numbered_chart(mesh, triangles, vertices);
  SurfaceMesh surface = cgal_mesh(mesh, chart, vertices);
  const Halfedge border = border_of(surface);
  PlaceMap places = surface.add_property_map<Vertex, Kernel::Point_2>("v:place").first;
  const smp::LSCM_parameterizer_3<SurfaceMesh> parameterizer;
  if (smp::parameterize(surface, parameterizer, border, places) != smp::OK) return {};
  chart.places.resize(static_cast<Eigen::Index>(vertices.size()), 2);
  for (const Vertex v : surface.vertices()) {
    chart.places.row(static_cast<Eigen::Index>(v.idx())) << places[v].x(), places[v].y();
  }
  if (!scale_to_surface(mesh, chart) || !keeps_lengths(mesh, chart)) return {};
  if (!has_simple_border(surface, border, chart)) return {};
  return chart;
}

}  // namespace morphbake
