#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "morphbake/gltf/document.h"
#include "morphbake/gltf/glb_draft.h"

namespace morphbake::test {

/// How numbers are written into a file.
struct NumberForm {
  int component_type = kFloatComponent;
  bool is_normalized = false;
  std::size_t stride = 0;  ///< 0: tight, without byteStride
};

constexpr NumberForm kInt8{5120, true, 4};
constexpr NumberForm kInt16{5122, true, 8};

/// A glTF with morph targets that no rule of any profile objects to; tests then spoil it.
///
/// A tetrahedron whose targets "one", "two", ... each move a vertex, and an animation that begins
/// and ends at rest.
struct MorphFile {
  GlbDraft draft;

  explicit MorphFile(int targets = 2, bool with_normals = false) {
    draft.shown = "morph.glb";
    draft.json = Json::parse(R"({
      "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"name": "Body", "mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {}, "targets": []}],
                  "extras": {"targetNames": []}, "weights": []}]})");
    primitive()["attributes"]["POSITION"] = append({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    if (with_normals) {
      primitive()["attributes"]["NORMAL"] = append({1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    }
    primitive()["indices"] = append({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR", {5125});
    for (int t = 0; t < targets; ++t) add_target(t, with_normals);
    add_animation(targets);
  }

  Json& node() { return draft.json["nodes"][0]; }

  Json& mesh() { return draft.json["meshes"][0]; }

  Json& primitive() { return mesh()["primitives"][0]; }

  Json& target(int index) { return primitive()["targets"][static_cast<std::size_t>(index)]; }

  Json& sampler() { return draft.json["animations"][0]["samplers"][0]; }

  /// The accessor that a field names.
  Json& accessor(const Json& index) { return draft.accessors[index.get<std::size_t>()]; }

  Json& view_of(const Json& accessor_index) {
    return draft.views[accessor(accessor_index)["bufferView"].get<std::size_t>()];
  }

  /// Appends numbers with their bounds, as an accessor in a bufferView of its own.
  ///
  /// @param type  "SCALAR" or "VEC3"
  int append(const std::vector<double>& numbers, const std::string& type,
             const NumberForm& form = {}) {
    const std::size_t columns = type == "VEC3" ? 3 : 1;
    const std::string bytes = bytes_of(numbers, columns, form);
    const int view = append_view(draft, bytes.data(), bytes.size(), BufferUse::Other);
    if (form.stride > 0) draft.views[static_cast<std::size_t>(view)]["byteStride"] = form.stride;
    Json accessor = {{"bufferView", view},
                     {"componentType", form.component_type},
                     {"count", numbers.size() / columns},
                     {"type", type}};
    if (form.is_normalized) accessor["normalized"] = true;
    for (std::size_t c = 0; c < columns; ++c) {
      double low = numbers[c], high = numbers[c];
      for (std::size_t i = c; i < numbers.size(); i += columns) {
        low = std::min(low, numbers[i]);
        high = std::max(high, numbers[i]);
      }
      accessor["min"].push_back(low);
      accessor["max"].push_back(high);
    }
    return append_accessor(draft, std::move(accessor));
  }

  /// Lets an accessor be sparse with one element, over zeros or over what it has.
  void make_sparse(const Json& index, bool keeps_view) {
    const std::uint32_t row = 1;
    const float value[3] = {0, 0, 0.5F};
    const int rows = append_view(draft, &row, sizeof row, BufferUse::Other);
    const int values = append_view(draft, value, sizeof value, BufferUse::Other);
    Json& at = accessor(index);
    at["sparse"] = {{"count", 1},
                    {"indices", {{"bufferView", rows}, {"componentType", 5125}}},
                    {"values", {{"bufferView", values}}}};
    if (keeps_view) return;
    at.erase("bufferView");
    at["min"] = {0, 0, 0};
    at["max"] = {0, 0, 0.5};
  }

  /// Puts numbers into the place of an animation's.
  void set_weights(const std::vector<double>& times, const std::vector<double>& weights) {
    sampler()["input"] = append(times, "SCALAR");
    sampler()["output"] = append(weights, "SCALAR");
  }

  GltfFile open() const {
    GlbDraft copy = draft;
    return open_gltf_bytes(glb_bytes(copy), draft.shown);
  }

 private:
  void add_target(int index, bool with_normals) {
    std::vector<double> moved(12, 0);
    moved[static_cast<std::size_t>(3 * (index % 4))] = 0.25;
    Json added = {{"POSITION", append(moved, "VEC3")}};
    if (with_normals) added["NORMAL"] = append(std::vector<double>(12, 0), "VEC3");
    primitive()["targets"].push_back(added);
    mesh()["extras"]["targetNames"].push_back("target " + std::to_string(index));
    mesh()["weights"].push_back(0);
  }

  /// 0, then the first target to 1, then 0.
  void add_animation(int targets) {
    if (targets == 0) return;
    std::vector<double> weights(static_cast<std::size_t>(3 * targets), 0);
    weights[static_cast<std::size_t>(targets)] = 1;
    draft.json["animations"] = {
        {{"name", "Play"},
         {"samplers",
          {{{"input", append({0, 0.5, 1}, "SCALAR")},
            {"output", append(weights, "SCALAR")},
            {"interpolation", "LINEAR"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  }

  template <typename Number>
  static void put(std::string& bytes, double value) {
    const auto number = static_cast<Number>(value);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }

  static std::string bytes_of(const std::vector<double>& numbers, std::size_t columns,
                              const NumberForm& form) {
    std::string bytes;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (form.stride > 0 && i % columns == 0) bytes.resize(i / columns * form.stride, '\0');
      if (form.component_type == 5120) put<std::int8_t>(bytes, numbers[i]);
      if (form.component_type == 5122) put<std::int16_t>(bytes, numbers[i]);
      if (form.component_type == 5121) put<std::uint8_t>(bytes, numbers[i]);
      if (form.component_type == 5125) put<std::uint32_t>(bytes, numbers[i]);
      if (form.component_type == kFloatComponent) put<float>(bytes, numbers[i]);
    }
    if (form.stride > 0) bytes.resize(numbers.size() / columns * form.stride, '\0');
    return bytes;
  }
};

}  // namespace morphbake::test
