#pragma once

// Internal to gltf/: how much a file may ask for. Memory follows the size of the file: accessors
// that all read the same bytes, or none at all, could ask for any amount.

#include <cstddef>
#include <vector>

#include "morphbake/gltf/document.h"

namespace morphbake {

/// Elements of an accessor without a bufferView.
constexpr std::size_t kMostZeros = std::size_t{1} << 23;

/// Values in the JSON of a file: a tree of them takes some hundred bytes each.
constexpr std::size_t kMostJsonValues = std::size_t{1} << 21;

/// Bytes of a file's JSON, with the data in it: text takes some times its size while it is parsed.
constexpr std::size_t kMostJsonBytes = std::size_t{5} << 25;

/// Checks the JSON's names and strings, but for the URIs of buffers and images: 64 MiB in all.
///
/// @throws BakeError "gltf.too-large"
void check_text_size(const GltfDocument& document);

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
/// Vertices and indices of all primitives together: as many as the buffers have bytes, or 4
/// million. Rows of their targets' POSITION and NORMAL and (six each) of JOINTS_n: likewise, or 16
/// million.
/// @throws BakeError "gltf.too-large"
void check_mesh_size(const GltfDocument& document, int mesh);

/// As check_mesh_size, of several meshes together.
void check_mesh_sizes(const GltfDocument& document, const std::vector<int>& meshes);

/// Numbers that reading a pose may take of animation curves: those of all channels, since many
/// could name the same. Twice as many as the buffers have bytes, or 16 million.
std::size_t most_curve_numbers(const GltfDocument& document);

/// What decompressing may ask for, in bytes of output.
struct UnpackBudget {
  std::size_t left = 0;

  /// For a file of `bytes` bytes.
  static UnpackBudget of_file(std::size_t bytes);

  /// Whether there was room for `bytes` more; takes them.
  bool take(std::size_t bytes);
};

}  // namespace morphbake
