#pragma once

#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/gltf_file.h"
#include "morphbake/gltf/mesh_choice.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The geometry of one primitive, in the shape that was chosen.
struct PrimitiveGeometry {
  Triangles triangles;  ///< #F by 3, rows of this primitive, in the file's winding
  Float3s positions;    ///< #V by 3, mesh space
  Float3s normals;      ///< #V by 3, mesh space, or no rows
};

/// The mesh of a source file that was chosen.
struct SourceGeometry {
  int node = 0;
  int mesh = 0;
  Eigen::Matrix4d to_scene = Eigen::Matrix4d::Identity();  ///< from mesh space
  std::vector<PrimitiveGeometry> primitives;
  bool is_at_rest = true;  ///< the shape that the file shows: no target or moment was chosen
  bool is_posed = false;   ///< by its skeleton
};

/// Reads the mesh that a source brings, of triangle primitives.
///
/// Its shape is that of a target or of a moment of an animation where one is chosen, else what the
/// file shows at rest. A skinned mesh is as it was bound, but for a moment: then its skeleton poses
/// it, and it is told in the space of its node, which is where it stands without a skin.
/// @throws BakeError "gltf.no-mesh", "gltf.several-meshes", "gltf.no-such-node", ...,
/// "gltf.invalid",
///         "gltf.unsupported-primitive", "gltf.singular-transform", "gltf.mixed-normals",
///         "gltf.accessor", "gltf.not-finite", "gltf.too-large"
SourceGeometry read_source_geometry(const GltfFile& file, const MeshChoice& choice = {});

/// JSON pointer of a primitive, for messages.
std::string primitive_pointer(int mesh, std::size_t primitive);

}  // namespace morphbake
