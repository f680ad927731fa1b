#pragma once

#include <string>

#include "morphbake/gltf/gltf_file.h"

namespace morphbake {

/// A .glb in another encoding.
struct EncodedMorph {
  std::string glb;
  int node = 0;  ///< that shows the morph's mesh
};

/// How fine integers are.
struct QuantisedSteps {
  double position =
      0;  ///< mesh space, where 16 bits are finer than that: few numbers compress well
  int normal_bits = 16;  ///< 16 or 8
};

/// Positions and normals of a node's mesh, with their displacements, as integers
/// (KHR_mesh_quantization); whatever else the file has stays as it is.
///
/// Positions are fractions of a cube about the mesh, whose place and size a new node below each
/// node of the mesh has: one of its own, so that nothing else is scaled. Displacements of normals
/// stay floats where one exceeds 1, since integers cannot and weights are those of positions.
/// @param file  as write_morph_glb() writes it
/// @throws BakeError "export.cannot-quantise" when a skin or instances place the mesh;
///         "output.too-large"
EncodedMorph quantise_mesh(const GltfFile& file, int node, const QuantisedSteps& steps = {});

}  // namespace morphbake
