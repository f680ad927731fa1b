#pragma once

#include <string>

#include "morphbake/diff/file_difference.h"

namespace morphbake {

/// The colour of a difference.
///
/// @param share  of what is allowed, >= 0: 0 is grey, 1 is blue; what is beyond goes from yellow to
///               red at a thousand times as much. NaN, which is what could not be compared, is
///               violet.
/// @return       linear RGB
Eigen::Vector3f heat_colour(double share);

/// A mesh of the first file, moving as it does, whose colours (COLOR_0, without textures) are those
/// of its largest differences over time: the larger share of what is allowed, of positions or of
/// judged normals. Primitives that could not be compared are violet.
///
/// @throws BakeError as read_animated_mesh
AnimatedMesh heat_mesh(const FileDifference& difference, const MeshDifference& mesh);

/// The mesh with the largest share; one at least was compared.
const MeshDifference& worst_mesh(const FileDifference& difference);

/// The bytes of a .glb: the compared meshes of the first file at rest, in their places in the
/// scene, in the colours of heat_mesh.
///
/// @throws BakeError as read_animated_mesh, "output.too-large"
std::string heat_map_glb(const FileDifference& difference);

}  // namespace morphbake
