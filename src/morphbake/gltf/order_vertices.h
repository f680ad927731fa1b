#pragma once

#include <string>
#include <vector>

#include "morphbake/gltf/gltf_file.h"

namespace morphbake {

/// A .glb whose vertices and triangles lie in another order.
struct OrderedMorph {
  std::string glb;
  /// A primitive of the mesh each: which vertex of the file each one was; empty: all stay.
  std::vector<std::vector<int>> old_vertex;
};

/// Triangles in an order that serves vertex caches, vertices in that of their first use, as they
/// are read fast and compress well. Primitives that share accessors, and those of other than lists
/// of triangles, stay.
///
/// @param file  as write_morph_glb() writes it
/// @throws BakeError "output.too-large"
OrderedMorph order_vertices(const GltfFile& file, int node);

}  // namespace morphbake
