#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/corner_surface.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// Where a place is in the source's scene.
///
/// @param location  of the place, for messages
/// @throws BakeError "landmarks.out-of-range": the file has no such vertex or triangle
Eigen::Vector3d scene_position(const SourceMesh& source, const Place& place,
                               const Location& location);

/// Refuses a position that is more than 10 % of the diagonal away from the source's surface.
///
/// @throws BakeError "landmarks.off-surface"
void check_near_surface(const SourceMesh& source, const Eigen::Vector3d& position,
                        const Location& location);

/// Where the landmarks of a source lie on its surface.
///
/// A position is carried to the closest point of the surface, inside its triangle; vertices and
/// triangle points are exactly theirs. Warns "landmarks.off-surface" when a position is more than
/// 1 % of the diagonal away.
/// @param surface  of `source`
/// @param mesh     `surface` in the scene
/// @param ref      whose landmarks are meant
/// @throws BakeError with all problems found: "landmarks.out-of-range", "landmarks.unused-vertex",
///         "landmarks.dropped-face", "landmarks.off-surface" (more than 10 % of the diagonal),
///         "landmarks.same-point"
std::vector<SurfacePoint> landmark_points(const SourceMesh& source, const CornerSurface& surface,
                                          const Mesh& mesh, const SourceRef& ref,
                                          const Observer& observer);

}  // namespace morphbake
