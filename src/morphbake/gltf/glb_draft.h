#pragma once

// Internal to gltf/: a .glb in the making.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/json/json.h"

namespace morphbake {

constexpr int kFloatComponent = 5126;

/// Its JSON and its one buffer. bufferViews and accessors stand by themselves, so that adding some
/// leaves references into the rest of the JSON alone.
struct GlbDraft {
  Json json;
  Json views = Json::array();
  Json accessors = Json::array();
  std::string binary;

  void align() { binary.resize((binary.size() + 3) / 4 * 4, '\0'); }
};

/// What a bufferView holds, for graphics cards.
enum class BufferUse { Vertices, Indices, Other };

template <typename Rows>
Json column_minima(const Rows& rows) {
  Json numbers = Json::array();
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    numbers.push_back(rows.rows() ? static_cast<double>(rows.col(c).minCoeff()) : 0.0);
  }
  return numbers;
}

template <typename Rows>
Json column_maxima(const Rows& rows) {
  Json numbers = Json::array();
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    numbers.push_back(rows.rows() ? static_cast<double>(rows.col(c).maxCoeff()) : 0.0);
  }
  return numbers;
}

/// All of a file, its buffers one after the other as buffer 0.
///
/// @param json     of the file, which has `buffers.size()` buffers or fewer
/// @param buffers  their bytes
GlbDraft join_buffers(Json json, const std::vector<std::string_view>& buffers);

/// Appends bytes as a bufferView of its own; returns its index.
int append_view(GlbDraft& draft, const void* data, std::size_t byte_count, BufferUse use);

/// Appends an accessor; returns its index.
int append_accessor(GlbDraft& draft, Json accessor);

/// Appends float VEC3 vertex attributes with their bounds; returns their accessor.
int append_vectors(GlbDraft& draft, const Float3s& rows);

/// The finished file.
///
/// @param shown  what messages call it
/// @throws BakeError "output.too-large"
std::string glb_bytes(GlbDraft& draft, const std::filesystem::path& shown);

}  // namespace morphbake
