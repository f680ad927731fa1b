#pragma once

// Internal to gltf/: how much a file may ask for. Memory follows the size of the file: accessors
// that all read the same bytes, or none at all, could ask for any amount.

#include <cstddef>

#include "morphbake/gltf/document.h"

namespace morphbake {

/// Elements of an accessor without a bufferView.
constexpr std::size_t kMostZeros = std::size_t{1} << 23;

/// Values in the JSON of a file: a tree of them takes some hundred bytes each.
constexpr std::size_t kMostJsonValues = std::size_t{1} << 21;

/// Checks how many things a file has: each takes some hundred bytes once it is read.
///
/// @throws BakeError "gltf.too-large"
void check_list_sizes(const GltfDocument& document);

/// Checks what buffers and images take together; many could name the same bytes.
///
/// @param file_bytes  of the glTF itself
/// @throws BakeError "gltf.too-large"
void check_buffer_sizes(const GltfDocument& document, std::size_t file_bytes);

/// Checks what reading a mesh would take.
///
/// Vertices, indices and rows of targets of all primitives together: as many as the file has bytes,
/// or 4 million.
/// @throws BakeError "gltf.too-large"
void check_mesh_size(const GltfDocument& document, int mesh);

/// What decompressing may ask for, in bytes of output.
struct UnpackBudget {
  std::size_t left = 0;

  /// For a file of `bytes` bytes.
  static UnpackBudget of_file(std::size_t bytes);

  /// Whether there was room for `bytes` more; takes them.
  bool take(std::size_t bytes);
};

}  // namespace morphbake
