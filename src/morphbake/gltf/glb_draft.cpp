#include "morphbake/gltf/glb_draft.h"

#include <fmt/core.h>

#include <cstdint>
#include <limits>
#include <utility>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

void append_u32(std::string& bytes, std::size_t value) {
  const auto number = static_cast<std::uint32_t>(value);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

int append_view(GlbDraft& draft, const void* data, std::size_t byte_count, BufferUse use) {
  draft.align();
  Json view = {{"buffer", 0}, {"byteOffset", draft.binary.size()}, {"byteLength", byte_count}};
  if (use == BufferUse::Vertices) view["target"] = kArrayBuffer;
  if (use == BufferUse::Indices) view["target"] = kElementArrayBuffer;
  draft.binary.append(static_cast<const char*>(data), byte_count);
  Json& views = draft.json["bufferViews"];
  views.push_back(std::move(view));
  return static_cast<int>(views.size()) - 1;
}

int append_accessor(GlbDraft& draft, Json accessor) {
  Json& accessors = draft.json["accessors"];
  accessors.push_back(std::move(accessor));
  return static_cast<int>(accessors.size()) - 1;
}

int append_vectors(GlbDraft& draft, const Float3s& rows) {
  const int view =
      append_view(draft, rows.data(), static_cast<std::size_t>(rows.size()) * sizeof(float),
                  BufferUse::Vertices);
  return append_accessor(draft, {{"bufferView", view},
                                 {"componentType", kFloatComponent},
                                 {"count", rows.rows()},
                                 {"type", "VEC3"},
                                 {"min", column_minima(rows)},
                                 {"max", column_maxima(rows)}});
}

std::string glb_bytes(GlbDraft& draft, const std::filesystem::path& shown) {
  draft.align();
  draft.json["buffers"] = Json::array({{{"byteLength", draft.binary.size()}}});
  std::string text = draft.json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + 8 + draft.binary.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw BakeError(
        Problem{Severity::Error,
                "output.too-large",
                {shown.string(), "", 0, 0},
                fmt::format("the result would have {} bytes; a .glb holds 4 GiB", total),
                "use \"targets\": \"tracks\" or fewer frames"});
  }
  std::string bytes = "glTF";
  append_u32(bytes, 2);
  append_u32(bytes, total);
  append_u32(bytes, text.size());
  bytes += "JSON" + text;
  append_u32(bytes, draft.binary.size());
  bytes.append("BIN\0", 4);
  bytes += draft.binary;
  return bytes;
}

}  // namespace morphbake
