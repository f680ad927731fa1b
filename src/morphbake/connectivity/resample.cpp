#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "morphbake/connectivity/landmark_vertices.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"

// Finer triangles only where max_error needs them were tried in two ways: isotropic remeshing of
// these triangles alone, and splits of their longest edges. Both folded where the even triangles
// had bridged a hollow (7 and 11 thousand folds on a body): points between do not know which
// wall they belong to. CGAL 5.5 has no sizing field, so edges are finer everywhere.

namespace morphbake {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Surface::Vertex_index;
using Edge = Surface::Edge_index;
using Face = Surface::Face_index;

constexpr unsigned kIterations = 5;  // of splits, collapses, flips and smoothing
constexpr int kAttempts = 20;        // at finer and finer edges
constexpr double kFiner = 0.75;      // of the next attempt's edges
constexpr int kNoLandmark = -1;

/// The first source's surface on its way to the new connectivity. What must stay is marked on it,
/// so that marks go through splits and through copies.
struct Draft {
  Surface surface;

  Surface::Property_map<Edge, bool> hard() {
    return surface.add_property_map<Edge, bool>("e:hard", false).first;
  }

  Surface::Property_map<Vertex, bool> fixed() {
    return surface.add_property_map<Vertex, bool>("v:fixed", false).first;
  }

  Surface::Property_map<Vertex, int> landmark() {
    return surface.add_property_map<Vertex, int>("v:landmark", kNoLandmark).first;
  }
};

Draft draft_of(const LandmarkedMesh& from) {
  Draft draft;
  const Positions& positions = from.mesh.positions;
  for (int v = 0; v < positions.rows(); ++v) {
    draft.surface.add_vertex({positions(v, 0), positions(v, 1), positions(v, 2)});
  }
  const auto vertex = [](int v) { return Vertex(static_cast<unsigned>(v)); };
  for (int f = 0; f < from.mesh.triangles.rows(); ++f) {
    const auto corners = from.mesh.triangles.row(f);
    draft.surface.add_face(vertex(corners(0)), vertex(corners(1)), vertex(corners(2)));
  }
  auto hard = draft.hard();
  for (const Eigen::Vector2i& edge : from.hard_edges) {
    hard[draft.surface.edge(draft.surface.halfedge(vertex(edge(0)), vertex(edge(1))))] = true;
  }
  auto fixed = draft.fixed();
  auto landmark = draft.landmark();
  for (std::size_t i = 0; i < from.landmarks.size(); ++i) {
    fixed[vertex(from.landmarks[i])] = true;
    landmark[vertex(from.landmarks[i])] = static_cast<int>(i);
  }
  return draft;
}

/// Borders and hard edges may be split but not shortened, so they keep their curves.
void remesh_evenly(Draft& draft, double edge_length) {
  namespace parameters = CGAL::parameters;
  CGAL::Polygon_mesh_processing::isotropic_remeshing(faces(draft.surface), edge_length,
                                                     draft.surface,
                                                     parameters::number_of_iterations(kIterations)
                                                         .collapse_constraints(false)
                                                         .edge_is_constrained_map(draft.hard())
                                                         .vertex_is_constrained_map(draft.fixed()));
  draft.surface.collect_garbage();
}

/// `point` exactly on the edge or corner that it misses by rounding.
SurfacePoint snapped(SurfacePoint point) {
  constexpr double kRounding = 1e-12;
  point.barycentric = (point.barycentric.array() < kRounding).select(0, point.barycentric);
  point.barycentric /= point.barycentric.sum();
  return point;
}

/// Where each vertex of the draft lies on the first source.
std::vector<SurfacePoint> points_on(const SourceSurface& first, Draft& draft) {
  const Surface& surface = draft.surface;
  Positions positions(static_cast<Eigen::Index>(surface.number_of_vertices()), 3);
  for (const Vertex v : surface.vertices()) {
    const Kernel::Point_3& p = surface.point(v);
    positions.row(static_cast<Eigen::Index>(v.idx())) << p.x(), p.y(), p.z();
  }
  std::vector<SurfacePoint> points = closest_points(first.mesh, positions);
  const auto landmark = draft.landmark();
  for (const Vertex v : surface.vertices()) {
    const int index = landmark[v];
    points[v.idx()] = index == kNoLandmark ? snapped(points[v.idx()])
                                           : first.landmarks[static_cast<std::size_t>(index)];
  }
  return points;
}

/// The triangles and marks of a draft as plain data.
SharedTriangulation plain(Draft& draft, std::size_t landmark_count) {
  SharedTriangulation result;
  const Surface& surface = draft.surface;
  const auto landmark = draft.landmark();
  result.landmarks.assign(landmark_count, 0);
  for (const Vertex v : surface.vertices()) {
    const int index = landmark[v];
    if (index != kNoLandmark) {
      result.landmarks[static_cast<std::size_t>(index)] = static_cast<int>(v.idx());
    }
    result.on_boundary.push_back(surface.is_border(v) ? 1 : 0);
  }
  result.connectivity.vertex_count = static_cast<int>(surface.number_of_vertices());
  result.connectivity.triangles.resize(static_cast<Eigen::Index>(surface.number_of_faces()), 3);
  for (const Face f : surface.faces()) {
    int k = 0;
    for (const Vertex v : surface.vertices_around_face(surface.halfedge(f))) {
      result.connectivity.triangles(static_cast<Eigen::Index>(f.idx()), k++) =
          static_cast<int>(v.idx());
    }
  }
  const auto hard = draft.hard();
  for (const Edge e : surface.edges()) {
    if (!hard[e]) continue;
    const int a = static_cast<int>(surface.vertex(e, 0).idx());
    const int b = static_cast<int>(surface.vertex(e, 1).idx());
    result.hard_edges.emplace_back(std::min(a, b), std::max(a, b));
  }
  return result;
}

/// The draft's vertices found on the first source and carried to all.
SharedTriangulation carried(Draft& draft, const std::vector<SourceSurface>& surfaces) {
  SharedTriangulation result = plain(draft, surfaces[0].landmarks.size());
  const std::vector<SurfacePoint> points = points_on(surfaces[0], draft);
  for (const SourceSurface& source : surfaces) {
    Positions& geometry = result.geometries.emplace_back(result.connectivity.vertex_count, 3);
    for (std::size_t v = 0; v < points.size(); ++v) {
      geometry.row(static_cast<Eigen::Index>(v)) = position_of(source.mesh, points[v]).transpose();
    }
    result.on_source.push_back(points);
  }
  return result;
}

double largest_distance_to(const Mesh& mesh, const Positions& positions) {
  const std::vector<SurfacePoint> points = closest_points(mesh, positions);
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d from = positions.row(static_cast<Eigen::Index>(i));
    largest = std::max(largest, (position_of(mesh, points[i]) - from).norm());
  }
  return largest;
}

/// Whether K and the sources are nowhere further apart than max_error: looked at in the middles of
/// K's triangles and edges, and at the sources' vertices.
bool meets(const std::vector<SourceSurface>& surfaces, const SharedTriangulation& triangulation,
           double max_error) {
  const Triangles& triangles = triangulation.connectivity.triangles;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const Mesh& source = surfaces[s].mesh;
    const Mesh k{triangulation.geometries[s], triangles};
    const double tolerance = max_error * bounding_diagonal(source.positions);
    if (largest_distance_to(k, source.positions) > tolerance) return false;
    Positions middles(4 * triangles.rows(), 3);
    for (int f = 0; f < triangles.rows(); ++f) {
      const Eigen::Matrix3d corners = k.positions(triangles.row(f), Eigen::all);
      middles.row(4 * f) = corners.colwise().mean();
      for (int c = 0; c < 3; ++c) {
        middles.row(4 * f + 1 + c) = (corners.row(c) + corners.row((c + 1) % 3)) / 2;
      }
    }
    if (largest_distance_to(source, middles) > tolerance) return false;
  }
  return true;
}

/// How many vertices an even triangulation of `area` has.
double expected_vertices(double area, double edge_length) {
  return area / (std::sqrt(3.0) / 2 * edge_length * edge_length);
}

void check_same_triangles(const std::vector<SourceSurface>& surfaces) {
  for (const SourceSurface& other : surfaces) {
    const Triangles& triangles = other.mesh.triangles;
    const Triangles& first = surfaces[0].mesh.triangles;
    if (triangles.rows() == first.rows() && triangles == first) continue;
    throw BakeError(Problem{
        Severity::Error,
        "connectivity.different-triangles",
        {other.file, "", 0, 0},
        fmt::format("\"{}\" and \"{}\" do not share their triangles, so they cannot be resampled",
                    other.name, surfaces[0].name),
        "\"mode\": \"remesh\" is for sources of different triangles"});
  }
}

/// The first source with the hard edges of all.
SourceSurface with_all_hard_edges(const std::vector<SourceSurface>& surfaces) {
  SourceSurface first = surfaces.front();
  for (std::size_t s = 1; s < surfaces.size(); ++s) {
    const std::vector<Eigen::Vector2i>& more = surfaces[s].hard_edges;
    first.hard_edges.insert(first.hard_edges.end(), more.begin(), more.end());
  }
  return first;
}

void check_vertex_count(const SourceSurface& first, double count, const RemeshOptions& options) {
  if (count <= options.max_vertices) return;
  const double fitting = options.target_edge_length * std::sqrt(count / options.max_vertices);
  throw BakeError(Problem{
      Severity::Error,
      "connectivity.too-many-vertices",
      {first.file, "", 0, 0},
      fmt::format("edges of {:.3g} of the diagonal make about {:.0f} vertices of \"{}\", more than "
                  "max_vertices ({})",
                  options.target_edge_length, count, first.name, options.max_vertices),
      fmt::format("a target_edge_length of {:.2g} fits, or allow more vertices", 1.05 * fitting)});
}

}  // namespace

SharedTriangulation resample(const std::vector<SourceSurface>& surfaces,
                             const RemeshOptions& options, const Observer& observer) {
  check_same_triangles(surfaces);
  const SourceSurface first = with_all_hard_edges(surfaces);
  const double area = triangle_areas(first.mesh.positions, first.mesh.triangles).sum();
  double edge_length = options.target_edge_length * bounding_diagonal(first.mesh.positions);
  check_vertex_count(first, expected_vertices(area, edge_length), options);
  const LandmarkedMesh landmarked = insert_landmarks(first);
  SharedTriangulation best;
  for (int attempt = 0; attempt < kAttempts; ++attempt, edge_length *= kFiner) {
    advance(observer, {"resample", attempt, kAttempts});
    if (expected_vertices(area, edge_length) > options.max_vertices) break;
    Draft draft = draft_of(landmarked);
    remesh_evenly(draft, edge_length);
    // Borders and hard edges are never made coarser, so there may be more than expected.
    const auto count = static_cast<double>(draft.surface.number_of_vertices());
    if (attempt == 0) check_vertex_count(first, count, options);
    if (count > options.max_vertices) break;
    best = carried(draft, surfaces);
    if (options.sizing == Sizing::Uniform || meets(surfaces, best, options.max_error)) break;
  }
  return best;
}

}  // namespace morphbake
