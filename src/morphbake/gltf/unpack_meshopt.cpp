#include <fmt/core.h>
#include <meshoptimizer.h>

#include "morphbake/gltf/packed_parts.h"

namespace morphbake {
namespace {

/// What the extension says of a bufferView.
struct Packing {
  std::size_t count = 0;
  std::size_t stride = 0;
  std::string mode;
  std::string filter;
};

/// What is wrong with it, or "": the decoder takes it for granted.
std::string fault_of(const Packing& packing) {
  const auto& [count, stride, mode, filter] = packing;
  if (mode == "ATTRIBUTES") {
    if (stride % 4 != 0 || stride == 0 || stride > 256) {
      return fmt::format("attributes have a stride of 4, 8, ... 256 bytes, not {}", stride);
    }
    if (filter == "OCTAHEDRAL" && stride != 4 && stride != 8) {
      return fmt::format("the filter OCTAHEDRAL needs a stride of 4 or 8, not {}", stride);
    }
    if (filter == "QUATERNION" && stride != 8) {
      return fmt::format("the filter QUATERNION needs a stride of 8, not {}", stride);
    }
    const bool is_known = filter == "NONE" || filter == "OCTAHEDRAL" || filter == "QUATERNION" ||
                          filter == "EXPONENTIAL";
    return is_known ? "" : fmt::format("there is no filter \"{}\"", filter);
  }
  if (mode != "TRIANGLES" && mode != "INDICES") return fmt::format("there is no mode \"{}\"", mode);
  if (filter != "NONE") return fmt::format("the filter {} is for attributes only", filter);
  if (stride != 2 && stride != 4) {
    return fmt::format("indices have a stride of 2 or 4 bytes, not {}", stride);
  }
  if (mode == "TRIANGLES" && count % 3 != 0) {
    return fmt::format("triangles need a multiple of 3 indices, not {}", count);
  }
  return "";
}

/// @return  whether the data is sound
bool decode(const Packing& packing, std::string_view packed, std::string& bytes) {
  const auto* data = reinterpret_cast<const unsigned char*>(packed.data());
  const auto& [count, stride, mode, filter] = packing;
  void* out = bytes.data();
  if (mode == "TRIANGLES") {
    return meshopt_decodeIndexBuffer(out, count, stride, data, packed.size()) == 0;
  }
  if (mode == "INDICES") {
    return meshopt_decodeIndexSequence(out, count, stride, data, packed.size()) == 0;
  }
  if (meshopt_decodeVertexBuffer(out, count, stride, data, packed.size()) != 0) return false;
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out, count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(out, count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out, count, stride);
  return true;
}

}  // namespace

std::string unpack_meshopt(const GltfDocument& document, const Json& extension,
                           std::string_view packed, UnpackBudget& budget,
                           const std::string& pointer) {
  const Packing packing{
      extension.at("count").get<std::size_t>(), extension.at("byteStride").get<std::size_t>(),
      extension.at("mode").get<std::string>(), extension.value("filter", std::string("NONE"))};
  if (const std::string fault = fault_of(packing); !fault.empty()) {
    fail_at(document, pointer, "gltf.meshopt", fault);
  }
  // Both are below 2^32.
  const std::size_t size = packing.count * packing.stride;
  if (!budget.take(size)) {
    fail_at(document, pointer, "gltf.too-large",
            fmt::format("unpacked, this bufferView would have {} bytes, too many for a file of "
                        "this size",
                        size));
  }
  std::string bytes(size, '\0');
  if (!decode(packing, packed, bytes)) {
    fail_at(document, pointer, "gltf.meshopt", "the compressed data is damaged",
            "export the file again, or unpack it with gltfpack");
  }
  return bytes;
}

}  // namespace morphbake
