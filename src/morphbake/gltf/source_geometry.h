#pragma once

#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/gltf_file.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The geometry of one primitive as it stands in the file.
struct PrimitiveGeometry {
  Triangles triangles;  ///< #F by 3, rows of this primitive, in the file's winding
  Float3s positions;    ///< #V by 3, mesh space
  Float3s normals;      ///< #V by 3, mesh space, or no rows
};

/// The one mesh of a source file.
struct SourceGeometry {
  int node = 0;
  int mesh = 0;
  Eigen::Matrix4d to_scene = Eigen::Matrix4d::Identity();  ///< global transform of the node
  std::vector<PrimitiveGeometry> primitives;
};

/// Reads the mesh that a source brings: one node with a mesh, made of indexed triangle primitives.
///
/// @throws BakeError "gltf.no-mesh", "gltf.several-meshes", "gltf.unsupported-primitive",
///         "gltf.unsupported-skin", "gltf.unsupported-targets", "gltf.singular-transform",
///         "gltf.mixed-normals", "gltf.accessor", ...
SourceGeometry read_source_geometry(const GltfFile& file);

/// JSON pointer of a primitive, for messages.
std::string primitive_pointer(int mesh, std::size_t primitive);

}  // namespace morphbake
