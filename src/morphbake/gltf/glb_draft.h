#pragma once

// Internal to gltf/: a .glb in the making.

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/json/json.h"

namespace morphbake {

constexpr int kFloatComponent = 5126;

/// Bytes of a draft's buffer.
struct ByteRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// What nothing refers to any more since something was put in its stead. What a user's file had
/// unused is none of it.
struct Leftovers {
  std::set<int> views;           ///< places for new ones
  std::set<int> accessors;       ///< likewise
  std::vector<ByteRange> bytes;  ///< some of which others may still show
};

/// Its JSON and its one buffer. bufferViews and accessors stand by themselves, so that adding some
/// leaves references into the rest of the JSON alone.
struct GlbDraft {
  Json json;
  Json views = Json::array();
  Json accessors = Json::array();
  std::string binary;
  std::vector<std::size_t> buffer_begins;  ///< in `binary`, one a buffer that was joined
  std::size_t fallback_bytes = 0;  ///< of a second buffer, which compressed bufferViews unpack to
  Leftovers leftovers;
  std::filesystem::path shown;  ///< what messages call the file

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

/// Appends bytes to the buffer; returns the fields of a bufferView of them.
///
/// @throws BakeError "output.too-large"
Json append_bytes(GlbDraft& draft, const void* data, std::size_t byte_count, BufferUse use);

/// Adds a bufferView, where one is left over or at the end; returns its index.
int add_view(GlbDraft& draft, Json view);

/// Adds bytes as a bufferView of its own; returns its index.
///
/// @throws BakeError "output.too-large"
int append_view(GlbDraft& draft, const void* data, std::size_t byte_count, BufferUse use);

/// Adds an accessor, where one is left over or at the end; returns its index.
int append_accessor(GlbDraft& draft, Json accessor);

/// Appends float VEC3 vertex attributes with their bounds; returns their accessor.
int append_vectors(GlbDraft& draft, const Float3s& rows);

/// Says that the file cannot be read without an extension.
void require_extension(Json& json, const char* name);

/// The finished file.
///
/// @throws BakeError "output.too-large"
std::string glb_bytes(GlbDraft& draft);

}  // namespace morphbake
