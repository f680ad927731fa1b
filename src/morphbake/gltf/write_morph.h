#pragma once

#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/gltf_file.h"

namespace morphbake {

/// Geometry of one primitive, mesh space. Rows are those of the file's own vertices.
struct PrimitiveMorph {
  Float3s positions;                      ///< #V by 3, with the file's own targets as at rest
  Float3s normals;                        ///< #V by 3, or no rows when the file has none
  std::vector<Float3s> target_positions;  ///< one a target: #V by 3 displacement
  std::vector<Float3s> target_normals;    ///< one a target, or empty: #V by 3 displacement
  Float3s colours = {};  ///< #V by 3 linear RGB, instead of the file's COLOR_0; or no rows
  std::vector<Float3s> target_colours = {};  ///< one a target, or empty: #V by 3 differences
  /// One a vertex: whether it is part of the surface. Empty: all are. Primitives may share their
  /// vertices, of which each has its own.
  std::vector<bool> is_used = {};
};

/// An animation of the weights.
struct MorphClip {
  std::string name;
  std::vector<float> key_times;  ///< seconds, rising strictly, the first is 0
  Eigen::MatrixXf key_weights;   ///< #keys by #targets, in [0, 1]
};

/// What is added to a mesh: targets and animations of their weights.
struct MeshMorph {
  int node = 0;
  int mesh = 0;
  bool replaces_base = false;              ///< whether the base shape is another than the file's
  bool drops_skin = false;                 ///< the base shape is posed, in the node's own space
  bool may_be_sparse = true;               ///< whether targets may be sparse accessors
  std::vector<PrimitiveMorph> primitives;  ///< one a primitive of the mesh
  std::vector<std::string> target_names;   ///< unique, non-empty; as wished
  std::vector<MorphClip> clips;            ///< one at least where there are targets
};

/// The bytes of a .glb: everything of `source`, and the morph.
///
/// Targets and animations are appended; a name that the file has already gets a number behind it.
/// The mesh's own targets and all animations of their weights stay; where new targets are, those
/// get the weights of the first clip's first key. A new base shape takes the place of the old one
/// as floats. Buffers become the binary chunk, without the bytes of what was replaced; images
/// outside the file are taken into it. Where the skin is dropped, the node gets a mesh of its own
/// if others pose it.
/// @throws BakeError "output.too-large", "gltf.singular-transform"; "gltf.too-large" and those of
///         reading for animations that cannot be
std::string write_morph_glb(const GltfFile& source, const MeshMorph& morph,
                            const std::string& generator);

}  // namespace morphbake
