#pragma once

#include <vector>

#include "morphbake/export/render_normals.h"

namespace morphbake {

/// Tangents of the vertices that a normal map needs them at.
struct RenderTangents {
  std::vector<bool> is_given;  ///< one a primitive: it has TANGENT and a normal map
  Eigen::MatrixX4f in_file;    ///< #R by 4: direction in mesh space and handedness; else rows of 0
  Positions surface;           ///< #R by 3, scene space: of the first source's surface, unit length
};

/// @return  no rows when no primitive needs tangents
RenderTangents find_tangents(const SourceMesh& first, const MorphableMesh& mesh,
                             const SmoothingGroups& groups);

/// Tangents of a deformed surface: the source's own, turned with the normal and with what the
/// surface makes of their direction.
///
/// @param positions  of K, scene space
/// @return           #R by 3, mesh space, unit length
Positions deformed_tangents(const RenderTangents& tangents, const SourceMesh& first,
                            const SmoothingGroups& groups, const MorphableMesh& mesh,
                            const Positions& positions);

}  // namespace morphbake
