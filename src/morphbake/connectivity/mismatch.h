#pragma once

#include <optional>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// A place at which two sources are not connected alike.
struct MismatchPlace {
  /// A triangle of a file there, and the middle of the side or the vertex that is meant.
  struct Spot {
    int triangle = 0;
    Eigen::RowVector3d position;  ///< scene space
  };

  std::optional<Spot> first;  ///< nothing where only the other source has the triangle
  std::optional<Spot> other;  ///< likewise
};

/// Where the welded surfaces of two sources differ, triangle by triangle in their files' order.
struct TopologyMismatch {
  int first_count = 0;               ///< triangles of the first source
  int other_count = 0;               ///< triangles of the other
  std::vector<int> first_triangles;  ///< rising: those without a counterpart, with other
                                     ///< neighbours, or at a torn vertex
  std::vector<int> other_triangles;  ///< likewise
  int other_neighbours = 0;  ///< triangles that lie beside another one than their counterpart
  int torn_vertices = 0;     ///< one vertex in one source, several in the other
  std::vector<MismatchPlace> places;  ///< the first three that share no vertex

  bool any() const {
    return first_count != other_count || other_neighbours > 0 || torn_vertices > 0;
  }
};

/// Compares two welded surfaces: equal triangles are neighbours over equal sides, and what is one
/// vertex here is one there. How the files split vertices does not matter.
///
/// Where the numbers of triangles differ, one run of triangles is taken to be missing, so that as
/// few as possible of the rest disagree.
/// @cost  O(#F log #F)
TopologyMismatch find_mismatch(const SourceMesh& first, const SourceMesh& other);

/// The error "connectivity.different-triangles" or "connectivity.different-topology" of the other
/// source, with the places on both.
Problem mismatch_problem(const SourceMesh& first, const SourceMesh& other,
                         const TopologyMismatch& mismatch);

}  // namespace morphbake
