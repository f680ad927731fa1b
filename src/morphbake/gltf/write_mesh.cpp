#include "morphbake/gltf/write_mesh.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "morphbake/gltf/document.h"
#include "morphbake/gltf/glb_draft.h"

namespace morphbake {
namespace {

constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kLinear = 9729;
constexpr int kLinearMipmapLinear = 9987;
constexpr int kClampToEdge = 33071;
constexpr Eigen::Index kShortLimit = 65535;  // this index itself restarts primitives

template <typename Number>
int append_index_view(GlbDraft& draft, const TriangleIndices& triangles) {
  std::vector<Number> numbers;
  for (Eigen::Index c = 0; c < triangles.size(); ++c) {
    numbers.push_back(static_cast<Number>(triangles.data()[c]));
  }
  return append_view(draft, numbers.data(), numbers.size() * sizeof(Number), BufferUse::Indices);
}

int append_indices(GlbDraft& draft, const PlainMesh& mesh) {
  const bool fits_short = mesh.positions.rows() <= kShortLimit;
  const int view = fits_short ? append_index_view<std::uint16_t>(draft, mesh.triangles)
                              : append_index_view<std::uint32_t>(draft, mesh.triangles);
  return append_accessor(draft, {{"bufferView", view},
                                 {"componentType", fits_short ? kUnsignedShort : kUnsignedInt},
                                 {"count", mesh.triangles.size()},
                                 {"type", "SCALAR"}});
}

int append_coordinates(GlbDraft& draft, const Float2s& rows) {
  const auto bytes = static_cast<std::size_t>(rows.size()) * sizeof(float);
  return append_accessor(
      draft, {{"bufferView", append_view(draft, rows.data(), bytes, BufferUse::Vertices)},
              {"componentType", kFloatComponent},
              {"count", rows.rows()},
              {"type", "VEC2"}});
}

Json json_of(const PlainMaterial& material) {
  const Eigen::Vector3d& colour = material.base_colour;
  Json json;
  if (!material.name.empty()) json["name"] = material.name;
  json["pbrMetallicRoughness"] = {{"baseColorFactor", {colour.x(), colour.y(), colour.z(), 1.0}},
                                  {"metallicFactor", material.metallic},
                                  {"roughnessFactor", material.roughness}};
  if (!material.base_colour_image.empty()) {
    json["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  }
  if (material.double_sided) json["doubleSided"] = true;
  return json;
}

/// Appends the material, and its picture as the one texture.
void place_material(GlbDraft& draft, const PlainMaterial& material) {
  draft.json["materials"] = Json::array({json_of(material)});
  const std::string& png = material.base_colour_image;
  if (png.empty()) return;
  const int view = append_view(draft, png.data(), png.size(), BufferUse::Other);
  draft.json["images"] = Json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
  draft.json["samplers"] = Json::array({{{"magFilter", kLinear},
                                         {"minFilter", kLinearMipmapLinear},
                                         {"wrapS", kClampToEdge},
                                         {"wrapT", kClampToEdge}}});
  draft.json["textures"] = Json::array({{{"sampler", 0}, {"source", 0}}});
}

}  // namespace

std::string write_mesh_glb(const PlainMesh& mesh, const std::string& generator) {
  GlbDraft draft;
  draft.shown = mesh.name;
  Json asset = {{"version", "2.0"}, {"generator", generator}};
  if (!mesh.copyright.empty()) asset["copyright"] = mesh.copyright;
  Json attributes = {{"POSITION", append_vectors(draft, mesh.positions)},
                     {"NORMAL", append_vectors(draft, mesh.normals)}};
  if (mesh.colours.rows() > 0) attributes["COLOR_0"] = append_vectors(draft, mesh.colours);
  if (mesh.texture_coordinates.rows() > 0) {
    attributes["TEXCOORD_0"] = append_coordinates(draft, mesh.texture_coordinates);
  }
  Json primitive = {{"attributes", std::move(attributes)}};
  primitive["indices"] = append_indices(draft, mesh);
  if (mesh.material) primitive["material"] = 0;
  draft.json = Json{{"asset", std::move(asset)},
                    {"scene", 0},
                    {"scenes", Json::array({{{"nodes", {0}}}})},
                    {"nodes", Json::array({{{"name", mesh.name}, {"mesh", 0}}})}};
  draft.json["meshes"] =
      Json::array({{{"name", mesh.name}, {"primitives", Json::array({std::move(primitive)})}}});
  if (mesh.material) place_material(draft, *mesh.material);
  return glb_bytes(draft);
}

std::optional<PlainMaterial> first_material(const GltfFile& file, int mesh) {
  const tinygltf::Model& model = file->model;
  const tinygltf::Mesh& parts = model.meshes[static_cast<std::size_t>(mesh)];
  const int index = parts.primitives.empty() ? -1 : parts.primitives.front().material;
  if (index < 0 || static_cast<std::size_t>(index) >= model.materials.size()) return {};
  const tinygltf::Material& from = model.materials[static_cast<std::size_t>(index)];
  const tinygltf::PbrMetallicRoughness& surface = from.pbrMetallicRoughness;
  PlainMaterial material;
  material.name = from.name;
  if (surface.baseColorFactor.size() >= 3) {
    material.base_colour = Eigen::Map<const Eigen::Vector3d>(surface.baseColorFactor.data());
  }
  material.metallic = surface.metallicFactor;
  material.roughness = surface.roughnessFactor;
  material.double_sided = from.doubleSided;
  return material;
}

std::string copyright_of(const GltfFile& file) { return file->model.asset.copyright; }

}  // namespace morphbake
