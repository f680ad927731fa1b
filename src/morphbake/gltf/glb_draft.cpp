#include "morphbake/gltf/glb_draft.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max();

void append_u32(std::string& bytes, std::size_t value) {
  const auto number = static_cast<std::uint32_t>(value);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void check_size(const GlbDraft& draft, std::size_t bytes) {
  if (bytes <= kMostBytes) return;
  throw BakeError(
      Problem{Severity::Error,
              "output.too-large",
              {draft.shown.string(), "", 0, 0},
              fmt::format("the result would have {} bytes or more; a .glb holds 4 GiB", bytes),
              "use \"targets\": \"tracks\" or fewer frames"});
}

/// Puts a part where one is left over, or at the end; returns its index.
int place(Json part, Json& list, std::set<int>& left_over) {
  if (left_over.empty()) {
    list.push_back(std::move(part));
    return static_cast<int>(list.size()) - 1;
  }
  const int index = left_over.extract(left_over.begin()).value();
  list[static_cast<std::size_t>(index)] = std::move(part);
  return index;
}

/// A list of the JSON's root, taken out of it.
Json taken_list(Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end()) return Json::array();
  Json list = std::move(*found);
  json.erase(name);
  return list;
}

/// Puts it back; glTF has no empty lists.
void put_list(GlbDraft& draft, const char* name, Json& list) {
  if (!list.empty()) draft.json[name] = std::move(list);
}

/// The fields of the buffer: those of the only one that there was, if it was one.
Json one_buffer(const GlbDraft& draft) {
  const auto buffers = draft.json.find("buffers");
  Json buffer =
      buffers != draft.json.end() && buffers->size() == 1 ? buffers->front() : Json::object();
  buffer.erase("uri");
  buffer["byteLength"] = draft.binary.size();
  return buffer;
}

/// What buffers have besides bytes: the one that is left has the first one's, and in its extras
/// what the others had.
void keep_buffer_fields(Json& json) {
  const auto buffers = json.find("buffers");
  if (buffers == json.end() || buffers->size() < 2) return;
  Json others = Json::array();
  for (std::size_t b = 1; b < buffers->size(); ++b) {
    Json fields = std::move((*buffers)[b]);
    for (const char* field : {"uri", "byteLength"}) fields.erase(field);
    if (!fields.empty()) others.push_back(std::move(fields));
  }
  buffers->erase(buffers->begin() + 1, buffers->end());
  if (others.empty()) return;
  Json& extras = buffers->front()["extras"];
  if (!extras.is_null() && !extras.is_object()) extras = Json{{"extras", std::move(extras)}};
  extras["joined"] = std::move(others);
}

}  // namespace

GlbDraft join_buffers(Json json, const std::vector<std::string_view>& buffers) {
  GlbDraft draft;
  draft.json = std::move(json);
  draft.views = taken_list(draft.json, "bufferViews");
  draft.accessors = taken_list(draft.json, "accessors");
  for (const std::string_view buffer : buffers) {
    draft.align();
    draft.buffer_begins.push_back(draft.binary.size());
    draft.binary.append(buffer);
  }
  keep_buffer_fields(draft.json);
  for (Json& view : draft.views) {
    const std::size_t begin = draft.buffer_begins.at(view.at("buffer").get<std::size_t>());
    view["buffer"] = 0;
    if (begin > 0) view["byteOffset"] = begin + view.value("byteOffset", std::size_t{0});
  }
  return draft;
}

Json append_bytes(GlbDraft& draft, const void* data, std::size_t byte_count, BufferUse use) {
  draft.align();
  check_size(draft, draft.binary.size() + byte_count);
  Json view = {{"buffer", 0}, {"byteOffset", draft.binary.size()}, {"byteLength", byte_count}};
  if (use == BufferUse::Vertices) view["target"] = kArrayBuffer;
  if (use == BufferUse::Indices) view["target"] = kElementArrayBuffer;
  draft.binary.append(static_cast<const char*>(data), byte_count);
  return view;
}

int add_view(GlbDraft& draft, Json view) {
  return place(std::move(view), draft.views, draft.leftovers.views);
}

int append_view(GlbDraft& draft, const void* data, std::size_t byte_count, BufferUse use) {
  return add_view(draft, append_bytes(draft, data, byte_count, use));
}

int append_accessor(GlbDraft& draft, Json accessor) {
  return place(std::move(accessor), draft.accessors, draft.leftovers.accessors);
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

void require_extension(Json& json, const char* name) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    Json& names = json[list];
    if (names.is_null()) names = Json::array();
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
}

std::string glb_bytes(GlbDraft& draft) {
  draft.align();
  if (draft.binary.empty()) {
    draft.json.erase("buffers");
  } else {
    draft.json["buffers"] = Json::array({one_buffer(draft)});
  }
  if (draft.fallback_bytes > 0) {
    const Json is_fallback = {{"fallback", true}};
    const Json extensions = {{"EXT_meshopt_compression", is_fallback}};
    draft.json["buffers"].push_back(
        Json{{"byteLength", draft.fallback_bytes}, {"extensions", extensions}});
  }
  put_list(draft, "bufferViews", draft.views);
  put_list(draft, "accessors", draft.accessors);
  std::string text = draft.json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t chunk = draft.binary.empty() ? 0 : 8 + draft.binary.size();
  const std::size_t total = 12 + 8 + text.size() + chunk;
  check_size(draft, total);
  std::string bytes = "glTF";
  bytes.reserve(total);
  append_u32(bytes, 2);
  append_u32(bytes, total);
  append_u32(bytes, text.size());
  bytes += "JSON" + text;
  if (draft.binary.empty()) return bytes;
  append_u32(bytes, draft.binary.size());
  bytes.append("BIN\0", 4);
  bytes += draft.binary;
  return bytes;
}

}  // namespace morphbake
