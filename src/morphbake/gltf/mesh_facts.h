#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "morphbake/gltf/gltf_file.h"
#include "morphbake/gltf/mesh_choice.h"

namespace morphbake {

/// A node that shows a mesh.
struct ShownMesh {
  int node = 0;
  int mesh = 0;
  std::string name;         ///< the node's, else the mesh's; may be empty
  bool is_surface = false;  ///< whether all primitives are triangles with POSITION
};

/// The meshes of the default scene in depth-first order; of all nodes where it shows none.
///
/// @throws BakeError "gltf.invalid", "gltf.not-finite"
std::vector<ShownMesh> shown_meshes(const GltfFile& file);

/// The mesh of a node that is named.
///
/// @throws BakeError "gltf.no-such-node", "gltf.no-mesh", "gltf.invalid", "gltf.not-finite"
ShownMesh mesh_of_node(const GltfFile& file, const NameOrIndex& node);

/// What a primitive is made of besides its geometry.
struct PrimitiveFacts {
  std::vector<std::string> attributes;         ///< rising: "COLOR_0", "NORMAL", "POSITION", ...
  std::vector<std::string> target_attributes;  ///< rising, of any target
  int material = -1;                           ///< index, -1 for none
};

/// One a primitive.
std::vector<PrimitiveFacts> primitive_facts(const GltfFile& file, int mesh);

/// How a material looks without its textures, with all of glTF's defaults filled in.
struct MaterialFacts {
  std::string name;
  Eigen::Vector4d base_colour = Eigen::Vector4d::Ones();  ///< linear RGB and alpha
  double metallic = 1;
  double roughness = 1;
  Eigen::Vector3d emissive = Eigen::Vector3d::Zero();  ///< linear RGB
  std::string alpha_mode = "OPAQUE";
  double alpha_cutoff = 0.5;
  bool double_sided = false;
};

/// @param material  index; -1, or one that there is not, is glTF's default material
MaterialFacts material_facts(const GltfFile& file, int material);

/// The bounds that a file states for the POSITIONs of a primitive, in the units of the numbers as
/// they are read.
struct StatedBounds {
  std::size_t primitive = 0;
  int target = -1;  ///< -1: the base shape
  Eigen::Vector3d min;
  Eigen::Vector3d max;
};

/// All that are stated of a mesh; accessors without bounds are left out.
std::vector<StatedBounds> stated_bounds(const GltfFile& file, int mesh);

}  // namespace morphbake
