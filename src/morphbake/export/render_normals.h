#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The corners that share a normal: one group for each vertex of K and distinct NORMAL of the first
/// source there. Hard edges separate groups; UV seams, whose sides have one normal, do not.
///
/// The corners are those of the file's triangles, wound as K: a sheet whose back is made of
/// duplicates has groups on both sides. Where the file's winding is the opposite, the surface's
/// normal is the opposite of the file's; it turns alike, which is all that is taken from it.
struct SmoothingGroups {
  int count = 0;               ///< 0 when a primitive of the source has no NORMAL
  std::vector<int> triangles;  ///< #T, of K: one for each triangle that the file draws
  std::vector<int> of_corner;  ///< 3 #T
  std::vector<int> of_render;  ///< #R of the first source, -1 when no triangle uses it
  Normals source_normals;      ///< #groups by 3, scene space: the source's own
  Normals surface_normals;     ///< #groups by 3, scene space: of the first source's surface
};

SmoothingGroups find_smoothing_groups(const SourceMesh& first, const MorphableMesh& mesh);

/// Normals of a deformed surface: the source's own, turned as the surface turns.
///
/// @param positions  of K, scene space
/// @return           #groups by 3, scene space
Normals deformed_normals(const SmoothingGroups& groups, const MorphableMesh& mesh,
                         const Positions& positions);

}  // namespace morphbake
