#pragma once

#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/gltf_file.h"

namespace morphbake {

/// New geometry of one primitive, mesh space. Rows are those of the file's own vertices.
struct PrimitiveMorph {
  Float3s positions;                      ///< #V by 3
  Float3s normals;                        ///< #V by 3, or no rows when the file has none
  std::vector<Float3s> target_positions;  ///< one a target: #V by 3 displacement
  std::vector<Float3s> target_normals;    ///< one a target, or empty: #V by 3 displacement
};

/// What is added to a mesh: targets and one animation of their weights.
struct MeshMorph {
  int node = 0;
  int mesh = 0;
  std::vector<PrimitiveMorph> primitives;  ///< one a primitive of the mesh
  std::vector<std::string> target_names;   ///< unique, non-empty
  std::string animation_name;
  std::vector<float> key_times;  ///< seconds, rising strictly, the first is 0; empty: no animation
  Eigen::MatrixXf key_weights;   ///< #keys by #targets, in [0, 1]
};

/// The bytes of a .glb: everything of `source`, with the morph in place of the mesh's geometry.
///
/// Base positions and normals are written over the old ones, targets and animation are appended;
/// buffers become the binary chunk; images outside the file are taken into it.
std::string write_morph_glb(const GltfFile& source, const MeshMorph& morph,
                            const std::string& generator);

}  // namespace morphbake
