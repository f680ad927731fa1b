#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"

namespace morphbake {

/// An accessor as it lies in its file, compressed or not.
struct StoredAccessor {
  int index = -1;
  int component_type =
      5126;  ///< glTF's: 5120 int8, 5121 uint8, 5122 int16, 5123 uint16, 5126 float
  bool is_normalized = false;
  int columns = 0;  ///< numbers an element
  std::size_t count = 0;
  int view = -1;           ///< its bufferView, -1 for none
  std::size_t offset = 0;  ///< bytes in it
  std::size_t stride = 0;  ///< byteStride of the bufferView, 0 where it has none
  bool is_sparse = false;
  bool is_meshopt = false;  ///< any bufferView of it has EXT_meshopt_compression
  /// What it takes in the file: its share of the bufferViews that it lies in.
  double file_bytes = 0;
  std::vector<double> declared_min, declared_max;  ///< #columns, or empty
  /// Of the stored numbers (integers of normalized ones); empty where nobody asked.
  std::vector<double> actual_min, actual_max;
};

/// What a primitive or one of its targets holds: "POSITION", "NORMAL", ...
struct StoredAttribute {
  std::string name;
  std::string pointer;  ///< into the glTF
  StoredAccessor accessor;
};

struct StoredPrimitive {
  std::string pointer;  ///< "/meshes/0/primitives/1"
  std::vector<StoredAttribute> attributes;
  std::vector<std::vector<StoredAttribute>> targets;  ///< one list a target
};

/// A channel that moves the weights of a node.
struct WeightsChannel {
  int animation = 0;           ///< of the file
  std::string pointer;         ///< of its sampler
  std::string animation_name;  ///< may be ""
  AnimationCurve curve;        ///< one number a target
  StoredAccessor times;
  StoredAccessor weights;
};

/// A node's mesh: what a viewer plays, and how the file says it.
struct MeshSurvey {
  AnimatedMesh mesh;  ///< with the last channel's weights
  std::string node_name;
  std::string node_pointer;
  std::string mesh_pointer;
  bool has_children = false;
  bool has_skin = false;
  bool has_scale = false;  ///< of the node itself, other than 1
  std::vector<std::string> extensions_used;
  std::optional<std::size_t> name_count;  ///< entries of extras.targetNames
  std::vector<double> mesh_weights;       ///< as declared; empty: none
  std::vector<double> node_weights;
  std::vector<StoredPrimitive> primitives;
  std::vector<WeightsChannel> channels;  ///< in the file's order
};

/// Looks at the mesh of a node with all that is told of how it is stored.
///
/// @throws BakeError as read_animated_mesh
MeshSurvey survey_mesh(const GltfFile& file, const MeshChoice& choice = {});

/// Looks at meshes of a file with all that is told of how they are stored.
///
/// @param choice  a chosen node alone; without one each mesh with morph targets, at the first node
///                that has it, or the first mesh where none has targets
/// @return        at least one
/// @throws BakeError as read_animated_mesh; "gltf.too-large" also when the meshes or weights
///         together ask for more than the file's bytes justify
std::vector<MeshSurvey> survey_meshes(const GltfFile& file, const MeshChoice& choice = {});

}  // namespace morphbake
