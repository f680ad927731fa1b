#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "morphbake/gltf/gltf_file.h"
#include "morphbake/gltf/mesh_choice.h"

namespace morphbake {

/// Numbers that a mesh's vertices have besides their place.
struct VertexAttribute {
  Eigen::MatrixXf values;          ///< #R by #columns: of all primitives one after the other
  std::vector<bool> is_given;      ///< one a primitive: those without it have rows of 0
  std::vector<std::string> names;  ///< what the primitives have, for messages
};

/// Reads one attribute of all primitives of a mesh.
///
/// @param name  as glTF writes it: "COLOR_0", "_MASK"
/// @return      no columns when no primitive has it
/// @throws BakeError "gltf.accessor" when its rows are not as many as positions, or primitives
///         differ in columns; "gltf.not-finite"
VertexAttribute read_vertex_attribute(const GltfFile& file, int mesh, const std::string& name);

/// The material of each primitive, -1 for none.
std::vector<int> primitive_materials(const GltfFile& file, int mesh);

/// Whether each primitive's material has a normal map.
std::vector<bool> normal_mapped_primitives(const GltfFile& file, int mesh);

/// Index of a material by name or index, or -1; its name is not looked for twice.
int find_material(const GltfFile& file, const NameOrIndex& choice);

/// Names of all materials.
std::vector<std::string> material_names(const GltfFile& file);

}  // namespace morphbake
