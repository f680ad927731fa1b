#include "morphbake/gltf/accessors.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace morphbake {
namespace {

template <typename Item>
const Item& item_at(const GltfDocument& document, const std::vector<Item>& items, int index,
                    const std::string& pointer, const char* kind) {
  if (index < 0 || static_cast<std::size_t>(index) >= items.size()) {
    fail_at(document, pointer, "gltf.accessor",
            fmt::format("{} {} does not exist; the file has {}", kind, index, items.size()));
  }
  return items[static_cast<std::size_t>(index)];
}

const tinygltf::Accessor& accessor_at(const GltfDocument& document, int accessor,
                                      const std::string& pointer) {
  return item_at(document, document.model.accessors, accessor, pointer, "accessor");
}

/// One component as a float: as it is, or a normalised integer (glTF 2.0, 3.6.2.2).
float component_value(const unsigned char* bytes, int type) {
  const auto load = [bytes](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<float>(value);
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return load(float{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load(std::uint8_t{}) / 255.0F;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load(std::uint16_t{}) / 65535.0F;
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return std::max(load(std::int8_t{}) / 127.0F, -1.0F);
    default:
      return std::max(load(std::int16_t{}) / 32767.0F, -1.0F);
  }
}

void check_components(const GltfDocument& document, int index, int columns,
                      const std::string& pointer) {
  const tinygltf::Accessor& accessor = accessor_at(document, index, pointer);
  const int type = accessor.componentType;
  const bool is_float = type == TINYGLTF_COMPONENT_TYPE_FLOAT && !accessor.normalized;
  const bool is_short_integer = type >= TINYGLTF_COMPONENT_TYPE_BYTE &&
                                type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                accessor.normalized;
  if (!is_float && !is_short_integer) {
    fail_at(document, pointer, "gltf.unsupported-accessor",
            fmt::format(
                "accessor {} has component type {}, neither float nor a normalised short integer",
                index, type));
  }
  if (const int found = accessor_columns(document, index, pointer); found != columns) {
    fail_at(
        document, pointer, "gltf.accessor",
        fmt::format("accessor {} has {} numbers an element instead of {}", index, found, columns));
  }
}

}  // namespace

ElementSpan element_span(const GltfDocument& document, int index, const std::string& pointer) {
  const tinygltf::Accessor& accessor = accessor_at(document, index, pointer);
  if (accessor.sparse.isSparse || accessor.bufferView < 0) {
    fail_at(document, fmt::format("/accessors/{}", index), "gltf.unsupported-accessor",
            "sparse accessors, and accessors without a bufferView, are not supported",
            "export without sparse accessors");
  }
  const std::string accessor_pointer = fmt::format("/accessors/{}", index);
  const auto& view = item_at(document, document.model.bufferViews, accessor.bufferView,
                             accessor_pointer + "/bufferView", "bufferView");
  const auto& buffer =
      item_at(document, document.model.buffers, view.buffer,
              fmt::format("/bufferViews/{}/buffer", accessor.bufferView), "buffer");
  const int component_size =
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  const int components =
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (component_size <= 0 || components <= 0) {
    fail_at(document, accessor_pointer, "gltf.accessor", "unknown component type or element type");
  }
  const std::size_t element =
      static_cast<std::size_t>(component_size) * static_cast<std::size_t>(components);
  const std::size_t stride = view.byteStride > 0 ? view.byteStride : element;
  const std::size_t size = buffer.data.size();
  // Each subtraction is guarded by the test before it, so that no sum can overflow.
  const bool view_inside = view.byteOffset <= size && view.byteLength <= size - view.byteOffset;
  const bool starts_inside = view_inside && accessor.byteOffset <= view.byteLength;
  const std::size_t room = starts_inside ? view.byteLength - accessor.byteOffset : 0;
  const bool fits = accessor.count > 0 && stride >= element && room >= element &&
                    accessor.count - 1 <= (room - element) / stride;
  if (!fits) {
    fail_at(document, accessor_pointer, "gltf.accessor",
            fmt::format("{} elements of {} bytes do not fit into the {} bytes of their bufferView",
                        accessor.count, element, view.byteLength),
            "the file was cut off or its exporter is at fault; export it again");
  }
  const std::size_t offset = view.byteOffset + accessor.byteOffset;
  return {buffer.data.data() + offset, stride, accessor.count, offset, view.buffer};
}

int accessor_columns(const GltfDocument& document, int accessor, const std::string& pointer) {
  const int type = accessor_at(document, accessor, pointer).type;
  return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
}

std::vector<float> read_floats(const GltfDocument& document, int accessor, int columns,
                               const std::string& pointer) {
  check_components(document, accessor, columns, pointer);
  const ElementSpan span = element_span(document, accessor, pointer);
  const int type = accessor_at(document, accessor, pointer).componentType;
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
  const auto width = static_cast<std::size_t>(columns);
  std::vector<float> values(span.count * width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const unsigned char* element = span.first + (i / width) * span.stride;
    values[i] = component_value(element + (i % width) * static_cast<std::size_t>(size), type);
    if (std::isfinite(values[i])) continue;
    fail_at(document, pointer, "gltf.not-finite",
            fmt::format("element {} of accessor {} is not a finite number", i / width, accessor));
  }
  return values;
}

Float3s read_float3s(const GltfDocument& document, int index, const std::string& pointer) {
  if (const int type = accessor_at(document, index, pointer).componentType;
      type != TINYGLTF_COMPONENT_TYPE_FLOAT) {
    fail_at(document, pointer, "gltf.unsupported-accessor",
            fmt::format("accessor {} has component type {}; only float (5126) is supported", index,
                        type),
            "export without quantisation");
  }
  const std::vector<float> values = read_floats(document, index, 3, pointer);
  return Eigen::Map<const Float3s>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
}

TriangleIndices read_triangles(const GltfDocument& document, int index, std::size_t vertex_count,
                               const std::string& pointer) {
  const tinygltf::Accessor& accessor = accessor_at(document, index, pointer);
  const ElementSpan span = element_span(document, index, pointer);
  const int type = accessor.componentType;
  const int size = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 1
                   : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 2
                   : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT   ? 4
                                                                    : 0;
  if (size == 0 || accessor.type != TINYGLTF_TYPE_SCALAR || span.count % 3 != 0) {
    fail_at(document, pointer, "gltf.accessor",
            fmt::format(
                "accessor {} holds no triangles: it needs a multiple of 3 unsigned scalars, not {}",
                index, span.count));
  }
  TriangleIndices triangles(static_cast<Eigen::Index>(span.count / 3), 3);
  for (std::size_t i = 0; i < span.count; ++i) {
    std::uint32_t vertex = 0;
    std::memcpy(&vertex, span.first + i * span.stride, static_cast<std::size_t>(size));
    if (vertex >= vertex_count) {
      fail_at(document, pointer, "gltf.accessor",
              fmt::format("index {} of accessor {} is {}, but there are {} vertices", i, index,
                          vertex, vertex_count));
    }
    triangles.data()[i] = static_cast<int>(vertex);
  }
  return triangles;
}

}  // namespace morphbake
