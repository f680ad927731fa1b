#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/core.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "morphbake/connectivity/landmark_vertices.h"
#include "morphbake/connectivity/polled_points.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/connectivity/surface_checks.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/adjacency.h"
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
constexpr double kFull = 0.97;       // of max_vertices: what the finest attempt aims at
constexpr double kSameEdges = 0.99;  // of the last attempt's: not worth another
constexpr double kSpareSplits = 1e5;
constexpr double kSplitsPerVertex = 4;  // of max_vertices
constexpr double kFlat = 1e-6;          // height over longest side: below, all is rounding to float
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
void remesh_evenly(Draft& draft, double edge_length, const Observer& observer) {
  namespace parameters = CGAL::parameters;
  Poll poll(observer);
  const PolledPoints points(draft.surface, poll);
  CGAL::Polygon_mesh_processing::isotropic_remeshing(faces(draft.surface), edge_length,
                                                     draft.surface,
                                                     parameters::number_of_iterations(kIterations)
                                                         .vertex_point_map(points)
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
std::vector<SurfacePoint> points_on(const SourceSurface& first, Draft& draft,
                                    const Observer& observer) {
  const Surface& surface = draft.surface;
  Positions positions(static_cast<Eigen::Index>(surface.number_of_vertices()), 3);
  for (const Vertex v : surface.vertices()) {
    const Kernel::Point_3& p = surface.point(v);
    positions.row(static_cast<Eigen::Index>(v.idx())) << p.x(), p.y(), p.z();
  }
  std::vector<SurfacePoint> points = closest_points(first.mesh, positions, observer);
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
SharedTriangulation carried(Draft& draft, const std::vector<SourceSurface>& surfaces,
                            const Observer& observer) {
  SharedTriangulation result = plain(draft, surfaces[0].landmarks.size());
  const std::vector<SurfacePoint> points = points_on(surfaces[0], draft, observer);
  for (const SourceSurface& source : surfaces) {
    Positions& geometry = result.geometries.emplace_back(result.connectivity.vertex_count, 3);
    for (std::size_t v = 0; v < points.size(); ++v) {
      geometry.row(static_cast<Eigen::Index>(v)) = position_of(source.mesh, points[v]).transpose();
    }
    result.on_source.push_back(points);
  }
  return result;
}

double largest_distance_to(const Mesh& mesh, const Positions& positions, const Observer& observer) {
  const std::vector<SurfacePoint> points = closest_points(mesh, positions, observer);
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d from = positions.row(static_cast<Eigen::Index>(i));
    largest = std::max(largest, (position_of(mesh, points[i]) - from).norm());
  }
  return largest;
}

/// Whether the middles of K's triangles and edges, and the source's vertices, are within a distance
/// of the other surface. Cheap, and mostly enough to see that edges are too long.
bool is_near_at_some_points(const Mesh& source, const Mesh& k, double tolerance,
                            const Observer& observer) {
  if (largest_distance_to(k, source.positions, observer) > tolerance) return false;
  Positions middles(4 * k.triangles.rows(), 3);
  for (int f = 0; f < k.triangles.rows(); ++f) {
    const Eigen::Matrix3d corners = k.positions(k.triangles.row(f), Eigen::all);
    middles.row(4 * f) = corners.colwise().mean();
    for (int c = 0; c < 3; ++c) {
      middles.row(4 * f + 1 + c) = (corners.row(c) + corners.row((c + 1) % 3)) / 2;
    }
  }
  return largest_distance_to(source, middles, observer) <= tolerance;
}

/// Whether K and the sources are nowhere further apart than max_error, as the report measures it.
bool meets(const std::vector<SourceSurface>& surfaces, const SharedTriangulation& triangulation,
           double max_error, const Observer& observer) {
  const auto everywhere = [&](const auto& is_near) {
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const Mesh& source = surfaces[s].mesh;
      const Mesh k{triangulation.geometries[s], triangulation.connectivity.triangles};
      if (!is_near(source, k, bounding_diagonal(source.positions))) return false;
    }
    return true;
  };
  return everywhere([&](const Mesh& source, const Mesh& k, double diagonal) {
           return is_near_at_some_points(source, k, max_error * diagonal, observer);
         }) &&
         everywhere([&](const Mesh& source, const Mesh& k, double diagonal) {
           const double bound = kHausdorffBound * diagonal;
           return hausdorff_distance(source, k, bound, observer) <= max_error * diagonal &&
                  hausdorff_distance(k, source, bound, observer) <= max_error * diagonal;
         });
}

/// How many vertices an even triangulation of `area` has.
double expected_vertices(double area, double edge_length) {
  return area / (std::sqrt(3.0) / 2 * edge_length * edge_length);
}

/// Edges to try after those of `length`, of which `best` is made: shorter by a step, but no more
/// than fill max_vertices, and well above those that were found to be too many.
double finer_edges(double length, double too_fine, const SharedTriangulation& best,
                   const RemeshOptions& options) {
  if (too_fine > 0) return std::sqrt(length * too_fine);
  const double room = kFull * options.max_vertices / best.connectivity.vertex_count;
  return length * std::max(kFiner, 1 / std::sqrt(room));
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

bool has_area(const Mesh& mesh, Eigen::Index triangle) {
  const Eigen::Matrix3d corners = mesh.positions(mesh.triangles.row(triangle), Eigen::all);
  const Eigen::RowVector3d u = corners.row(1) - corners.row(0), w = corners.row(2) - corners.row(0);
  const double longest = std::max({u.squaredNorm(), w.squaredNorm(), (w - u).squaredNorm()});
  return u.cross(w).norm() > kFlat * longest;
}

/// Pieces of the surface on which nothing has an area would have no place to be projected to.
void check_pieces_have_area(const SourceSurface& source) {
  constexpr std::size_t kPlaces = 3;  // how many places the message names
  const Triangles& triangles = source.mesh.triangles;
  const auto vertices = static_cast<int>(source.mesh.positions.rows());
  const Components pieces = connected_components(one_rings({vertices, triangles}));
  const auto piece_of = [&](Eigen::Index f) {
    const int label = pieces.label[static_cast<std::size_t>(triangles(f, 0))];
    return static_cast<std::size_t>(label);
  };
  std::vector<char> is_told(static_cast<std::size_t>(pieces.count), 0);  // or need not be
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    if (has_area(source.mesh, f)) is_told[piece_of(f)] = 1;
  }
  std::vector<std::string> places;
  for (Eigen::Index f = 0; f < triangles.rows() && places.size() < kPlaces; ++f) {
    if (std::exchange(is_told[piece_of(f)], 1) != 0) continue;
    const Eigen::RowVector3d at = source.mesh.positions.row(triangles(f, 0));
    places.push_back(fmt::format("({:.4g}, {:.4g}, {:.4g})", at(0), at(1), at(2)));
  }
  if (places.empty()) return;
  throw BakeError(Problem{
      Severity::Error,
      "connectivity.no-area",
      {source.file, "", 0, 0},
      fmt::format("\"{}\" has pieces without area: at {}", source.name, fmt::join(places, ", ")),
      "new triangles are made on the first source: name one first on which "
      "these pieces have an area"});
}

std::pair<int, int> edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The first source with the hard edges of all. Beside a triangle without area it is chance whether
/// an edge is found hard, and CGAL fails when it cannot turn such an edge: there none is.
SourceSurface with_all_hard_edges(const std::vector<SourceSurface>& surfaces) {
  SourceSurface first = surfaces.front();
  for (std::size_t s = 1; s < surfaces.size(); ++s) {
    const std::vector<Eigen::Vector2i>& more = surfaces[s].hard_edges;
    first.hard_edges.insert(first.hard_edges.end(), more.begin(), more.end());
  }
  std::set<std::pair<int, int>> beside_none;
  for (Eigen::Index f = 0; f < first.mesh.triangles.rows(); ++f) {
    if (has_area(first.mesh, f)) continue;
    for (int k = 0; k < 3; ++k) {
      beside_none.insert(edge_of(first.mesh.triangles(f, k), first.mesh.triangles(f, (k + 1) % 3)));
    }
  }
  std::erase_if(first.hard_edges, [&](const Eigen::Vector2i& edge) {
    return beside_none.contains(edge_of(edge(0), edge(1)));
  });
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

/// Long thin triangles are first split all along and only then merged: 200,000 of a double cone
/// took more than three minutes.
void check_split_count(const SourceSurface& first, double edge_length,
                       const RemeshOptions& options) {
  double splits = 0;
  for (const auto& corners : first.mesh.triangles.rowwise()) {
    for (int k = 0; k < 3; ++k) {
      const auto a = first.mesh.positions.row(corners(k));
      const auto b = first.mesh.positions.row(corners((k + 1) % 3));
      splits += std::max(0.0, (a - b).norm() / edge_length - 1) / 2;  // an edge has two triangles
    }
  }
  const double most = kSpareSplits + kSplitsPerVertex * options.max_vertices;
  if (splits <= most) return;
  throw BakeError(
      Problem{Severity::Error,
              "connectivity.too-thin",
              {first.file, "", 0, 0},
              fmt::format("the triangles of \"{}\" are so long and thin that about {:.0f} splits "
                          "would go before; {:.0f} are the most",
                          first.name, splits, most),
              "remesh it in a modeller first, or allow more max_vertices"});
}

}  // namespace

SharedTriangulation resample(const std::vector<SourceSurface>& surfaces,
                             const RemeshOptions& options, const Observer& observer) {
  check_same_triangles(surfaces);
  check_pieces_have_area(surfaces[0]);
  const SourceSurface first = with_all_hard_edges(surfaces);
  const double area = triangle_areas(first.mesh.positions, first.mesh.triangles).sum();
  double edge_length = options.target_edge_length * bounding_diagonal(first.mesh.positions);
  check_vertex_count(first, expected_vertices(area, edge_length), options);
  check_split_count(first, edge_length, options);
  const LandmarkedMesh landmarked = insert_landmarks(first);
  SharedTriangulation best;
  double fitting_length = edge_length;
  double too_fine = 0;  // edges of which there are more than max_vertices
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    advance(observer, {"resample", attempt, kAttempts});
    Draft draft = draft_of(landmarked);
    remesh_evenly(draft, edge_length, observer);
    // Borders and hard edges are never made coarser, so there may be more than expected.
    const auto count = static_cast<double>(draft.surface.number_of_vertices());
    if (attempt == 0) check_vertex_count(first, count, options);
    if (count > options.max_vertices) {
      too_fine = edge_length;
    } else {
      best = carried(draft, surfaces, observer);
      if (options.sizing == Sizing::Uniform) return best;
      if (meets(surfaces, best, options.max_error, observer)) return best;
      fitting_length = edge_length;
    }
    edge_length = finer_edges(fitting_length, too_fine, best, options);
    best.is_full = edge_length > kSameEdges * fitting_length;
    if (best.is_full) break;
  }
  return best;
}

}  // namespace morphbake
