#include "morphbake/gltf/accessors.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "morphbake/gltf/size_limits.h"

namespace morphbake {
namespace {

/// Where elements lie, checked to be inside their buffer; `first` is null when they are all 0.
struct ElementSpan {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
  std::size_t count = 0;
};

/// Where they should lie.
struct SpanRequest {
  int view = 0;
  std::size_t offset = 0;   ///< in the view
  std::size_t element = 0;  ///< bytes of one
  std::size_t count = 0;
};

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

/// @param pointer  of the accessor, or of its part that asks
ElementSpan span_of(const GltfDocument& document, const SpanRequest& request,
                    const std::string& pointer) {
  const auto& view = item_at(document, document.model.bufferViews, request.view,
                             pointer + "/bufferView", "bufferView");
  const auto& buffer = item_at(document, document.buffers, view.buffer,
                               fmt::format("/bufferViews/{}/buffer", request.view), "buffer");
  const std::size_t stride = view.byteStride > 0 ? view.byteStride : request.element;
  const std::size_t size = buffer.size();
  // Each subtraction is guarded by the test before it, so that no sum can overflow.
  const bool view_inside = view.byteOffset <= size && view.byteLength <= size - view.byteOffset;
  const bool starts_inside = view_inside && request.offset <= view.byteLength;
  const std::size_t room = starts_inside ? view.byteLength - request.offset : 0;
  const bool fits = request.count > 0 && stride >= request.element && room >= request.element &&
                    request.count - 1 <= (room - request.element) / stride;
  if (!fits) {
    fail_at(document, pointer, "gltf.accessor",
            fmt::format("{} elements of {} bytes do not fit into the {} bytes of their bufferView",
                        request.count, request.element, view.byteLength),
            "the file was cut off or its exporter is at fault; export it again");
  }
  const auto* first = reinterpret_cast<const unsigned char*>(buffer.data());
  return {first + view.byteOffset + request.offset, stride, request.count};
}

ElementSpan element_span(const GltfDocument& document, int index, const std::string& pointer) {
  const tinygltf::Accessor& accessor = accessor_at(document, index, pointer);
  const std::string place = fmt::format("/accessors/{}", index);
  const std::size_t component = component_bytes(accessor.componentType);
  const int components =
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (component == 0 || components <= 0) {
    fail_at(document, place, "gltf.accessor", "unknown component type or element type");
  }
  const std::size_t element = component * static_cast<std::size_t>(components);
  if (accessor.bufferView >= 0) {
    return span_of(document, {accessor.bufferView, accessor.byteOffset, element, accessor.count},
                   place);
  }
  if (accessor.count > kMostZeros) {
    fail_at(document, place + "/count", "gltf.too-large",
            fmt::format("{} elements without a bufferView; at most {} can be read", accessor.count,
                        kMostZeros),
            "export the file again");
  }
  return {nullptr, element, accessor.count};
}

/// Components of one element, as floats.
template <typename Component>
void convert(const unsigned char* bytes, std::size_t columns, bool normalised, float* out) {
  for (std::size_t c = 0; c < columns; ++c) {
    Component value;
    std::memcpy(&value, bytes + c * sizeof value, sizeof value);
    out[c] = static_cast<float>(value);
    if constexpr (std::numeric_limits<Component>::is_integer) {
      constexpr auto kOne = static_cast<float>(std::numeric_limits<Component>::max());
      if (normalised) out[c] = std::max(out[c] / kOne, -1.0F);
    }
  }
}

using Conversion = void (*)(const unsigned char*, std::size_t, bool, float*);

Conversion conversion_from(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return convert<float>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert<std::uint8_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert<std::uint16_t>;
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return convert<std::int8_t>;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return convert<std::int16_t>;
    default:
      return nullptr;
  }
}

/// Converts all elements of a span to rows of `columns` floats.
void convert_span(const ElementSpan& span, int type, bool normalised, std::size_t columns,
                  float* out) {
  if (!span.first) {
    std::fill_n(out, span.count * columns, 0.0F);
    return;
  }
  if (type == TINYGLTF_COMPONENT_TYPE_FLOAT && span.stride == columns * sizeof(float)) {
    std::memcpy(out, span.first, span.count * span.stride);
    return;
  }
  const Conversion conversion = conversion_from(type);
  for (std::size_t i = 0; i < span.count; ++i) {
    conversion(span.first + i * span.stride, columns, normalised, out + i * columns);
  }
}

template <typename Number>
void convert_unsigned(const ElementSpan& span, std::size_t columns, std::uint32_t* out) {
  for (std::size_t i = 0; i < span.count; ++i) {
    for (std::size_t c = 0; c < columns; ++c) {
      Number value;
      std::memcpy(&value, span.first + i * span.stride + c * sizeof value, sizeof value);
      out[i * columns + c] = value;
    }
  }
}

/// Elements of 1, 2 or 4 unsigned bytes a number.
void convert_unsigned(const ElementSpan& span, std::size_t bytes, std::size_t columns,
                      std::uint32_t* out) {
  if (!span.first) {
    std::fill_n(out, span.count * columns, 0U);
  } else if (bytes == 1) {
    convert_unsigned<std::uint8_t>(span, columns, out);
  } else if (bytes == 2) {
    convert_unsigned<std::uint16_t>(span, columns, out);
  } else {
    convert_unsigned<std::uint32_t>(span, columns, out);
  }
}

std::vector<std::uint32_t> unsigned_numbers(const ElementSpan& span, std::size_t bytes,
                                            std::size_t columns) {
  std::vector<std::uint32_t> values(span.count * columns);
  convert_unsigned(span, bytes, columns, values.data());
  return values;
}

bool is_unsigned(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// Which elements a sparse accessor replaces, and by what.
struct SparseElements {
  std::vector<std::uint32_t> rows;  ///< rising, each below the accessor's count
  ElementSpan values;
};

/// @param element  bytes of one element of the accessor
SparseElements sparse_elements(const GltfDocument& document, int index, std::size_t element) {
  const auto at = static_cast<std::size_t>(index);
  const Json& accessor = document.json.at("accessors").at(at);
  const Json& sparse = accessor.at("sparse");
  const std::string pointer = fmt::format("/accessors/{}/sparse", index);
  const auto count = sparse.at("count").get<std::size_t>();
  const Json &indices = sparse.at("indices"), &values = sparse.at("values");
  const auto offset_of = [](const Json& part) { return part.value("byteOffset", std::size_t{0}); };
  const auto view_of = [](const Json& part) {
    return static_cast<int>(
        std::min<std::uint64_t>(part.at("bufferView").get<std::uint64_t>(), INT32_MAX));
  };
  const std::size_t width = component_bytes(indices.at("componentType").get<int>());
  const ElementSpan rows =
      span_of(document, {view_of(indices), offset_of(indices), width, count}, pointer + "/indices");
  SparseElements found;
  found.rows = unsigned_numbers(rows, width, 1);
  found.values =
      span_of(document, {view_of(values), offset_of(values), element, count}, pointer + "/values");
  const std::size_t all = document.model.accessors[at].count;
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    const bool rises = i == 0 || found.rows[i] > found.rows[i - 1];
    if (rises && found.rows[i] < all) continue;
    fail_at(document, pointer + "/indices", "gltf.accessor",
            fmt::format("index {} is {}; indices rise and are below the accessor's {}", i,
                        found.rows[i], all));
  }
  return found;
}

bool is_sparse(const GltfDocument& document, int index) {
  return document.model.accessors[static_cast<std::size_t>(index)].sparse.isSparse;
}

void check_components(const GltfDocument& document, int index, int columns,
                      const std::string& pointer) {
  const tinygltf::Accessor& accessor = accessor_at(document, index, pointer);
  if (conversion_from(accessor.componentType) == nullptr) {
    fail_at(document, pointer, "gltf.accessor",
            fmt::format("accessor {} has component type {}, which is for indices only", index,
                        accessor.componentType));
  }
  if (const int found = accessor_columns(document, index, pointer); found != columns) {
    fail_at(
        document, pointer, "gltf.accessor",
        fmt::format("accessor {} has {} numbers an element instead of {}", index, found, columns));
  }
}

/// Reads the elements of `index` to `out`, which has room for them.
///
/// @param span  element_span(document, index, pointer) of a checked accessor
void read_numbers(const GltfDocument& document, int index, const ElementSpan& span,
                  const std::string& pointer, float* out) {
  const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
  const int type = accessor.componentType;
  const auto columns = static_cast<std::size_t>(accessor_columns(document, index, pointer));
  convert_span(span, type, accessor.normalized, columns, out);
  if (is_sparse(document, index)) {
    const SparseElements sparse = sparse_elements(document, index, columns * component_bytes(type));
    const Conversion conversion = conversion_from(type);
    for (std::size_t i = 0; i < sparse.rows.size(); ++i) {
      conversion(sparse.values.first + i * sparse.values.stride, columns, accessor.normalized,
                 out + sparse.rows[i] * columns);
    }
  }
  if (type != TINYGLTF_COMPONENT_TYPE_FLOAT) return;
  const float* first = out;
  const float* end = first + span.count * columns;
  const Eigen::Map<const Eigen::ArrayXf> numbers(first, end - first);
  if ((numbers - numbers).sum() == 0) return;  // the difference is NaN where one is not finite
  const float* bad = std::find_if(first, end, [](float value) { return !std::isfinite(value); });
  fail_at(document, pointer, "gltf.not-finite",
          fmt::format("element {} of accessor {} is not a finite number",
                      static_cast<std::size_t>(bad - first) / columns, index));
}

template <typename Rows>
Rows read_rows(const GltfDocument& document, int index, const std::string& pointer) {
  check_components(document, index, static_cast<int>(Rows::ColsAtCompileTime), pointer);
  const ElementSpan span = element_span(document, index, pointer);
  Rows rows(static_cast<Eigen::Index>(span.count), static_cast<int>(Rows::ColsAtCompileTime));
  read_numbers(document, index, span, pointer, rows.data());
  return rows;
}

}  // namespace

std::size_t component_bytes(int type) {
  return static_cast<std::size_t>(
      std::max(0, tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type))));
}

std::size_t components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  const auto side = static_cast<std::size_t>(type.back() - '0');
  return type.starts_with("MAT") ? side * side : side;
}

std::size_t accessor_count(const GltfDocument& document, int accessor, const std::string& pointer) {
  return accessor_at(document, accessor, pointer).count;
}

int accessor_columns(const GltfDocument& document, int accessor, const std::string& pointer) {
  const int type = accessor_at(document, accessor, pointer).type;
  return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
}

void check_count(const GltfDocument& document, int accessor, std::size_t vertices,
                 const std::string& pointer) {
  const std::size_t count = accessor_count(document, accessor, pointer);
  if (count == vertices) return;
  fail_at(document, pointer, "gltf.accessor",
          fmt::format("the attribute has {} elements for {} positions", count, vertices));
}

std::vector<float> read_floats(const GltfDocument& document, int index, int columns,
                               const std::string& pointer) {
  check_components(document, index, columns, pointer);
  const ElementSpan span = element_span(document, index, pointer);
  std::vector<float> values(span.count * static_cast<std::size_t>(columns));
  read_numbers(document, index, span, pointer, values.data());
  return values;
}

Float2s read_float2s(const GltfDocument& document, int index, const std::string& pointer) {
  return read_rows<Float2s>(document, index, pointer);
}

Float3s read_float3s(const GltfDocument& document, int index, const std::string& pointer) {
  return read_rows<Float3s>(document, index, pointer);
}

std::size_t index_count(const GltfDocument& document, int index, const std::string& pointer) {
  const tinygltf::Accessor& accessor = accessor_at(document, index, pointer);
  if (!is_unsigned(accessor.componentType) || accessor.type != TINYGLTF_TYPE_SCALAR) {
    fail_at(document, pointer, "gltf.accessor",
            fmt::format("accessor {} holds no indices: it needs unsigned scalars", index));
  }
  return element_span(document, index, pointer).count;
}

void read_indices(const GltfDocument& document, int index, std::size_t vertices,
                  const std::string& pointer, std::span<int> out) {
  const tinygltf::Accessor& accessor = accessor_at(document, index, pointer);
  const std::size_t width = component_bytes(accessor.componentType);
  // Straight to where they stay, as what they are in the file.
  const std::span indices(reinterpret_cast<std::uint32_t*>(out.data()), out.size());
  convert_unsigned(element_span(document, index, pointer), width, 1, indices.data());
  if (is_sparse(document, index)) {
    const SparseElements sparse = sparse_elements(document, index, width);
    const std::vector<std::uint32_t> values = unsigned_numbers(sparse.values, width, 1);
    for (std::size_t i = 0; i < values.size(); ++i) indices[sparse.rows[i]] = values[i];
  }
  const auto bad = std::find_if(indices.begin(), indices.end(),
                                [vertices](std::uint32_t vertex) { return vertex >= vertices; });
  if (bad == indices.end()) return;
  fail_at(document, pointer, "gltf.accessor",
          fmt::format("index {} of accessor {} is {}, but there are {} vertices",
                      bad - indices.begin(), index, *bad, vertices));
}

std::vector<std::uint32_t> read_joints(const GltfDocument& document, int index,
                                       const std::string& pointer) {
  const tinygltf::Accessor& accessor = accessor_at(document, index, pointer);
  const bool is_small = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                        accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (!is_small || accessor.type != TINYGLTF_TYPE_VEC4 || is_sparse(document, index)) {
    fail_at(document, pointer, "gltf.accessor",
            fmt::format("accessor {} holds no joints: it needs four unsigned bytes or shorts an "
                        "element",
                        index));
  }
  return unsigned_numbers(element_span(document, index, pointer),
                          component_bytes(accessor.componentType), 4);
}

}  // namespace morphbake
