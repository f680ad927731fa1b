#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/gltf_file.h"

namespace morphbake {

/// A glTF material with one texture at most.
struct PlainMaterial {
  std::string name;
  Eigen::Vector3d base_colour = Eigen::Vector3d::Ones();  ///< linear RGB factor
  double metallic = 1;                                    ///< 0 to 1
  double roughness = 1;                                   ///< 0 to 1
  bool double_sided = false;
  std::string base_colour_image = {};  ///< bytes of a PNG, or "" for no texture
};

/// A mesh of one primitive.
struct PlainMesh {
  std::string name;             ///< of node and mesh
  std::string copyright;        ///< or ""
  TriangleIndices triangles;    ///< #F by 3
  Float3s positions;            ///< #V by 3
  Float3s normals;              ///< #V by 3, unit length
  Float3s colours;              ///< #V by 3 linear RGB in [0, 1] (COLOR_0), or no rows
  Float2s texture_coordinates;  ///< #V by 2 (TEXCOORD_0), or no rows
  std::optional<PlainMaterial> material;
};

/// The bytes of a .glb with one node, one mesh and one primitive.
///
/// @param generator  stands in asset.generator
/// @throws BakeError "output.too-large"
std::string write_mesh_glb(const PlainMesh& mesh, const std::string& generator);

/// The material of the first primitive of mesh `mesh` without its textures, or nothing without one.
std::optional<PlainMaterial> first_material(const GltfFile& file, int mesh);

/// asset.copyright, or "".
std::string copyright_of(const GltfFile& file);

}  // namespace morphbake
