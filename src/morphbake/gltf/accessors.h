#pragma once

// Internal to gltf/: checked reads of accessors. Nothing is allocated before the sizes were
// checked.

#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/document.h"

namespace morphbake {

/// Where an accessor's elements lie, checked to be inside their buffer.
struct ElementSpan {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
  std::size_t count = 0;
  std::size_t offset_in_buffer = 0;
  int buffer = 0;
};

/// @param pointer  the place that names the accessor, for messages
/// @throws BakeError "gltf.accessor" out of range, "gltf.unsupported-accessor" sparse
ElementSpan element_span(const GltfDocument& document, int accessor, const std::string& pointer);

/// The accessor's VEC3 elements, stored as floats (not as normalised integers), all finite.
/// @throws BakeError "gltf.accessor", "gltf.unsupported-accessor", "gltf.not-finite"
Float3s read_float3s(const GltfDocument& document, int accessor, const std::string& pointer);

/// The accessor's elements of `columns` numbers each, row by row; normalised integers become
/// floats.
std::vector<float> read_floats(const GltfDocument& document, int accessor, int columns,
                               const std::string& pointer);

/// Numbers an element of the accessor has: 1 for SCALAR to 16 for MAT4.
int accessor_columns(const GltfDocument& document, int accessor, const std::string& pointer);

/// Triangle indices of a primitive, each below `vertex_count`.
TriangleIndices read_triangles(const GltfDocument& document, int accessor, std::size_t vertex_count,
                               const std::string& pointer);

}  // namespace morphbake
