#include "morphbake/connectivity/mesh_health.h"

#include <Eigen/LU>
#include <algorithm>
#include <cstdint>
#include <limits>

#include "morphbake/connectivity/surface_checks.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/boundary.h"
#include "morphbake/mesh/open_seams.h"
#include "morphbake/mesh/orientation.h"
#include "morphbake/sources/corner_surface.h"

namespace morphbake {
namespace {

constexpr std::size_t kPlaces = 3;

/// How often the search for self-intersections may ask whether to stop, once in a thousand points:
/// a dense, even torus of a million triangles takes a little less.
std::int64_t most_polls(Eigen::Index triangles) { return 20000 + 3 * triangles / 10; }

/// A source's mended surface in the scene.
struct Examined {
  const SourceMesh& source;
  CornerSurface corners;
  Mesh mesh;
};

void add(HealthFinding& finding, const Eigen::RowVector3d& position, int triangle_in_file) {
  ++finding.count;
  if (finding.places.size() < kPlaces) finding.places.push_back({position, triangle_in_file});
}

Eigen::RowVector3d corner_in_file(const SourceMesh& source, int triangle, int k) {
  return source.positions.row(source.triangles(triangle, k));
}

int triangle_in_file(const Examined& examined, int triangle) {
  return examined.corners.file_corner[3 * static_cast<std::size_t>(triangle)] / 3;
}

Eigen::RowVector3d middle_of(const Mesh& mesh, int triangle) {
  Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
  for (const int v : mesh.triangles.row(triangle)) middle += mesh.positions.row(v) / 3;
  return middle;
}

void find_mended(const Examined& examined, MeshHealth& health) {
  const CornerSurface& corners = examined.corners;
  for (int f = 0; f < health.triangles; ++f) {
    const int kept = corners.triangle_of_file[static_cast<std::size_t>(f)];
    const Eigen::RowVector3d at = corner_in_file(examined.source, f, 0);
    if (kept < 0) {
      add(health.degenerate_triangles, at, f);
    } else if (triangle_in_file(examined, kept) != f) {
      add(health.duplicate_triangles, at, f);
    }
  }
  const bool is_mirrored =
      examined.source.geometry.to_scene.topLeftCorner<3, 3>().determinant() < 0;
  for (int f = 0; f < examined.mesh.triangles.rows(); ++f) {
    if (runs_as_in_file(corners, f) != is_mirrored) continue;
    add(health.turned_triangles, middle_of(examined.mesh, f), triangle_in_file(examined, f));
  }
}

/// A triangle at each vertex.
std::vector<int> triangles_at(const Examined& examined) {
  std::vector<int> at(static_cast<std::size_t>(examined.mesh.positions.rows()), -1);
  for (Eigen::Index c = examined.mesh.triangles.size() - 1; c >= 0; --c) {
    at[static_cast<std::size_t>(examined.mesh.triangles.data()[c])] = static_cast<int>(c / 3);
  }
  return at;
}

/// A triangle at an edge.
int triangle_at(const Triangles& triangles, const Eigen::Vector2i& edge) {
  for (int f = 0; f < triangles.rows(); ++f) {
    const auto row = triangles.row(f).array();
    if ((row == edge(0)).any() && (row == edge(1)).any()) return f;
  }
  return 0;
}

/// Edges as places at their middles.
HealthFinding edges_found(const Examined& examined, const std::vector<Eigen::Vector2i>& edges) {
  const auto& [positions, triangles] = examined.mesh;
  HealthFinding finding;
  finding.count = static_cast<int>(edges.size());
  for (std::size_t i = 0; i < std::min(kPlaces, edges.size()); ++i) {
    finding.places.push_back({(positions.row(edges[i](0)) + positions.row(edges[i](1))) / 2,
                              triangle_in_file(examined, triangle_at(triangles, edges[i]))});
  }
  return finding;
}

void find_refused(const Examined& examined, MeshHealth& health) {
  const ManifoldDefects defects =
      find_manifold_defects(examined.corners.connectivity, std::numeric_limits<int>::max());
  health.crowded_edges = edges_found(examined, defects.crowded_edges);
  const std::vector<int> triangle_of = triangles_at(examined);
  for (const int v : defects.pinched_vertices) {
    add(health.pinched_vertices, examined.mesh.positions.row(v),
        triangle_in_file(examined, triangle_of[static_cast<std::size_t>(v)]));
  }
  for (const int f : find_orientation(examined.mesh.triangles).twisted_pieces) {
    add(health.twisted_pieces, middle_of(examined.mesh, f), triangle_in_file(examined, f));
  }
}

/// Loops and handles of an oriented manifold, by V - E + F = 2 - 2 g - b of each component.
void find_shape(const Examined& examined, MeshHealth& health) {
  const OneRings rings = one_rings(examined.corners.connectivity);
  health.components = connected_components(rings).count;
  if (health.is_refused()) return;
  const auto vertices = static_cast<int>(examined.mesh.positions.rows());
  const auto edges = static_cast<int>(rings.neighbours.size() / 2);
  const auto triangles = static_cast<int>(examined.mesh.triangles.rows());
  const auto loops = static_cast<int>(boundary_loops(examined.mesh.triangles).size());
  health.boundary_loops = loops;
  health.genus = (2 * health.components - loops - (vertices - edges + triangles)) / 2;
}

/// Asks the caller whether to stop, and ends after a fixed number of questions: the same on every
/// machine.
class Patience {
 public:
  Patience(const Observer& caller, std::int64_t most_polls)
      : caller_(caller), most_polls_(most_polls) {}

  Observer observer() {
    Observer watching;
    watching.is_cancelled = [this] {
      is_over_ = ++polls_ > most_polls_;
      return is_over_ || (caller_.is_cancelled && caller_.is_cancelled());
    };
    return watching;
  }

  bool is_over() const { return is_over_; }

 private:
  const Observer& caller_;
  std::int64_t most_polls_;
  std::int64_t polls_ = 0;
  bool is_over_ = false;
};

void find_self_intersections(const Examined& examined, const Observer& observer,
                             MeshHealth& health) {
  if (health.is_refused()) return;  // CGAL's search takes manifolds only
  Patience patience(observer, most_polls(examined.mesh.triangles.rows()));
  try {
    HealthFinding found;
    for (const auto& [f, g] : self_intersections(examined.mesh, patience.observer())) {
      if (f == g) continue;  // a triangle without area, of three different points in a line
      const HealthPlace place{middle_of(examined.mesh, f), triangle_in_file(examined, f)};
      ++found.count;
      const bool is_told =
          std::any_of(found.places.begin(), found.places.end(),
                      [&](const HealthPlace& told) { return told.triangle == place.triangle; });
      if (!is_told && found.places.size() < kPlaces) found.places.push_back(place);
    }
    health.more_self_intersections = found.count == kMostSelfIntersections;
    health.self_intersections = found;
  } catch (const Cancelled&) {
    if (!patience.is_over()) throw;
  }
}

}  // namespace

MeshHealth examine_mesh(const SourceMesh& source, const Observer& observer) {
  Examined examined{source, surface_of_corners(source, welded_corners(source)), {}};
  examined.mesh = {vertex_positions(source, examined.corners),
                   examined.corners.connectivity.triangles};
  MeshHealth health;
  health.render_vertices = static_cast<int>(source.positions.rows());
  health.triangles = static_cast<int>(source.triangles.rows());
  std::vector<char> is_used(static_cast<std::size_t>(source.positions.rows()), 0);
  std::vector<char> is_point(static_cast<std::size_t>(source.welded_count), 0);
  for (const int render : source.triangles.reshaped()) {
    is_used[static_cast<std::size_t>(render)] = 1;
    is_point[static_cast<std::size_t>(source.welded[static_cast<std::size_t>(render)])] = 1;
  }
  health.unused_vertices = static_cast<int>(std::count(is_used.begin(), is_used.end(), char{0}));
  health.welded_vertices = static_cast<int>(std::count(is_point.begin(), is_point.end(), char{1}));
  stop_if_cancelled(observer);
  find_mended(examined, health);
  find_refused(examined, health);
  stop_if_cancelled(observer);
  find_shape(examined, health);
  health.open_seams =
      edges_found(examined, find_open_seams(examined.mesh.triangles, {examined.mesh.positions}));
  stop_if_cancelled(observer);
  find_self_intersections(examined, observer, health);
  return health;
}

}  // namespace morphbake
