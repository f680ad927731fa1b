#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/core.h>

#include <cstdint>
#include <map>
#include <memory>

#include "morphbake/gltf/packed_parts.h"

namespace morphbake {
namespace {

constexpr std::uint32_t kMostFaces = std::uint32_t{1} << 22;
constexpr std::size_t kBytesOfFace = 48;  // what the decoder needs for one, roughly
constexpr std::uint16_t kHasMetadata = 0x8000;
constexpr std::uint8_t kTriangleMesh = 1;
constexpr std::uint8_t kEdgebreaker = 1;

/// Where the compressed data is, for messages.
struct Place {
  const GltfDocument& document;
  const std::string& pointer;
};

[[noreturn]] void fail(const Place& place, const std::string& message) {
  fail_at(place.document, place.pointer, "gltf.draco", message,
          "export the file again, or without compression");
}

/// Number of faces that the data says it has: memory for them is taken before they are read.
std::uint32_t face_count(const Place& place, std::string_view packed) {
  constexpr std::size_t kMagic = 5;
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  std::uint8_t major = 0, minor = 0, type = 0, method = 0, traversal = 0;
  std::uint16_t flags = 0;
  std::uint32_t vertices = 0, faces = 0;
  const bool is_draco = packed.starts_with("DRACO");
  buffer.Advance(kMagic);
  if (!is_draco || !buffer.Decode(&major) || !buffer.Decode(&minor) || !buffer.Decode(&type) ||
      !buffer.Decode(&method) || !buffer.Decode(&flags)) {
    fail(place, "the bufferView holds no Draco data");
  }
  if (major != 2 || minor != 2) {
    fail(place, fmt::format("the data has version {}.{}; glTF's Draco has 2.2", major, minor));
  }
  if (type != kTriangleMesh) fail(place, "the data is a point cloud, not a mesh");
  draco::GeometryMetadata metadata;
  bool is_whole = (flags & kHasMetadata) == 0 ||
                  draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata);
  buffer.set_bitstream_version(0x0202);
  if (method == kEdgebreaker) {
    is_whole = is_whole && buffer.Decode(&traversal) && draco::DecodeVarint(&vertices, &buffer);
  }
  if (!is_whole || !draco::DecodeVarint(&faces, &buffer)) fail(place, "the data is cut off");
  return faces;
}

template <typename Number>
std::string numbers_of(const Place& place, const draco::Mesh& mesh,
                       const draco::PointAttribute& attribute, int columns) {
  const auto width = static_cast<std::size_t>(columns);
  std::vector<Number> row(width);
  std::string bytes(mesh.num_points() * width * sizeof(Number), '\0');
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    const draco::AttributeValueIndex value = attribute.mapped_index(p);
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue<Number>(value, static_cast<std::int8_t>(columns), row.data())) {
      fail(place, fmt::format("the value of point {} cannot be read", p.value()));
    }
    std::memcpy(bytes.data() + p.value() * width * sizeof(Number), row.data(),
                width * sizeof(Number));
  }
  return bytes;
}

using AttributesById = std::map<std::uint32_t, const draco::PointAttribute*>;

/// draco::Mesh looks for an id among all of its attributes.
AttributesById attributes_by_id(const draco::Mesh& mesh) {
  AttributesById attributes;
  for (int i = 0; i < mesh.num_attributes(); ++i) {
    attributes.emplace(mesh.attribute(i)->unique_id(), mesh.attribute(i));
  }
  return attributes;
}

std::string bytes_of(const Place& place, const draco::Mesh& mesh, const AttributesById& attributes,
                     const PackedAttribute& asked) {
  const auto found = attributes.find(static_cast<std::uint32_t>(asked.id));
  if (found == attributes.end()) {
    fail(place, fmt::format("the data has no attribute with the id {}", asked.id));
  }
  const draco::PointAttribute* attribute = found->second;
  if (attribute->num_components() != asked.columns || mesh.num_points() != asked.count) {
    fail(place, fmt::format("attribute {} has {} elements of {} numbers, but its accessor has {} "
                            "of {}",
                            asked.id, mesh.num_points(), attribute->num_components(), asked.count,
                            asked.columns));
  }
  switch (asked.component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return numbers_of<std::int8_t>(place, mesh, *attribute, asked.columns);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return numbers_of<std::uint8_t>(place, mesh, *attribute, asked.columns);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return numbers_of<std::int16_t>(place, mesh, *attribute, asked.columns);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return numbers_of<std::uint16_t>(place, mesh, *attribute, asked.columns);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return numbers_of<std::uint32_t>(place, mesh, *attribute, asked.columns);
    default:
      return numbers_of<float>(place, mesh, *attribute, asked.columns);
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): where, what, how much may be taken
UnpackedPrimitive unpack_draco(const GltfDocument& document, std::string_view packed,
                               std::size_t indices, const std::vector<PackedAttribute>& attributes,
                               UnpackBudget& budget, const std::string& pointer) {
  const Place place{document, pointer};
  const std::uint32_t faces = face_count(place, packed);
  if (std::size_t{3} * faces != indices) {
    fail(place, fmt::format("the data has {} triangles, but the accessor of the indices has {} "
                            "elements",
                            faces, indices));
  }
  std::size_t bytes = kBytesOfFace * faces;
  for (const PackedAttribute& attribute : attributes) {
    bytes += attribute.count * static_cast<std::size_t>(attribute.columns) * sizeof(float);
  }
  if (faces > kMostFaces || !budget.take(bytes)) {
    fail_at(document, pointer, "gltf.too-large",
            fmt::format("{} compressed triangles are too many for a file of this size; the most "
                        "are {}",
                        faces, kMostFaces),
            "export the file without compression");
  }
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) {
    fail(place, fmt::format("the data is damaged: {}", decoded.status().error_msg()));
  }
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  UnpackedPrimitive primitive;
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh->face(f)) {
      if (point.value() >= mesh->num_points())
        fail(place, "a triangle has a point that is not there");
      primitive.indices.push_back(point.value());
    }
  }
  if (primitive.indices.size() != indices) fail(place, "the data has fewer triangles than it says");
  const AttributesById by_id = attributes_by_id(*mesh);
  for (const PackedAttribute& attribute : attributes) {
    primitive.attributes.push_back(bytes_of(place, *mesh, by_id, attribute));
  }
  return primitive;
}

}  // namespace morphbake
