#pragma once

#include <optional>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// Where something was found: a point of the scene, and a triangle of the file, counted over its
/// primitives.
struct HealthPlace {
  Eigen::RowVector3d position;
  int triangle = 0;
};

/// How often something was found, and the first three places.
struct HealthFinding {
  int count = 0;
  std::vector<HealthPlace> places;
};

/// What is told of one source's mesh before anybody bakes it. Vertices are welded by exact
/// position; what a bake mends is counted apart, and the rest is that of the mended surface.
struct MeshHealth {
  int render_vertices = 0;
  int unused_vertices = 0;  ///< render vertices of no triangle
  int welded_vertices = 0;  ///< points of the triangles
  int triangles = 0;        ///< of the file
  int components = 0;

  HealthFinding degenerate_triangles;  ///< two corners at one point: left out by a bake
  HealthFinding duplicate_triangles;   ///< over the points of an earlier one: left out
  HealthFinding turned_triangles;      ///< against most others of their piece: turned

  HealthFinding crowded_edges;     ///< of more than two triangles: refused
  HealthFinding pinched_vertices;  ///< whose triangles form more than one fan: refused
  HealthFinding twisted_pieces;    ///< with one side only: refused

  HealthFinding open_seams;                         ///< border edges beside others: a warning
  std::optional<HealthFinding> self_intersections;  ///< pairs of triangles; nothing when they were
                                                    ///< not looked for, or too many to look through
  bool more_self_intersections = false;             ///< than were counted

  // Of surfaces that are not refused:
  std::optional<int> boundary_loops;
  std::optional<int> genus;  ///< summed over the components: handles

  /// Whether a bake refuses it.
  bool is_refused() const {
    return triangles == degenerate_triangles.count || crowded_edges.count > 0 ||
           pinched_vertices.count > 0 || twisted_pieces.count > 0;
  }
};

/// Examines a source's mesh; one that a bake refuses too.
///
/// @throws Cancelled
/// @cost    O(#F log #F), and the search for self-intersections: seconds for a million triangles.
///          It ends after a fixed amount of work, which surfaces that lie in heaps exceed.
MeshHealth examine_mesh(const SourceMesh& source, const Observer& observer = {});

}  // namespace morphbake
