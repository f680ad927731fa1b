#pragma once

#include <string>
#include <vector>

#include "morphbake/gltf/write_morph.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// A morph's bytes in the encoding that is asked for.
struct EncodedOutput {
  std::string glb;
  int node = 0;                              ///< that shows it
  std::vector<std::vector<int>> old_vertex;  ///< as OrderedMorph; without any primitives all stay
};

/// @param first     the source into whose file the morph goes
/// @param diagonal  of the first frame, scene units
/// @throws BakeError "output.too-large", "export.cannot-quantise"
EncodedOutput encode_output(const SourceMesh& first, const Output& output, double diagonal,
                            MeshMorph morph);

/// Puts vertices where they were before they were encoded, so that each can be compared with its
/// own.
///
/// @param old_vertex  as EncodedOutput
void restore_order(const std::vector<std::vector<int>>& old_vertex, AnimatedMesh& mesh);

}  // namespace morphbake
