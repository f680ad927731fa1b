#include "morphbake/gltf/mesh_facts.h"

#include <algorithm>
#include <limits>
#include <set>

#include "morphbake/gltf/document.h"
#include "morphbake/gltf/nodes.h"

namespace morphbake {
namespace {

using Attributes = std::map<std::string, int>;

bool is_surface(const tinygltf::Mesh& mesh) {
  return std::ranges::all_of(mesh.primitives, [](const tinygltf::Primitive& primitive) {
    const bool has_triangles = primitive.mode < 0 || primitive.mode >= TINYGLTF_MODE_TRIANGLES;
    return has_triangles && primitive.attributes.contains("POSITION");
  });
}

ShownMesh mesh_shown_by(const GltfDocument& document, int index) {
  const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(index)];
  const tinygltf::Mesh& mesh = document.model.meshes[static_cast<std::size_t>(node.mesh)];
  return {index, node.mesh, node.name.empty() ? mesh.name : node.name, is_surface(mesh)};
}

/// What stands for 1 in a normalised integer.
double unit_of(const tinygltf::Accessor& accessor) {
  if (!accessor.normalized) return 1;
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return std::numeric_limits<std::int8_t>::max();
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return std::numeric_limits<std::uint8_t>::max();
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return std::numeric_limits<std::int16_t>::max();
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return std::numeric_limits<std::uint16_t>::max();
    default:
      return 1;
  }
}

void add_bounds(const GltfDocument& document, const Attributes& attributes, StatedBounds bounds,
                std::vector<StatedBounds>& all) {
  const auto found = attributes.find("POSITION");
  if (found == attributes.end()) return;
  const auto index = static_cast<std::size_t>(found->second);
  if (index >= document.model.accessors.size()) return;
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  if (accessor.minValues.size() != 3 || accessor.maxValues.size() != 3) return;
  bounds.min = Eigen::Map<const Eigen::Vector3d>(accessor.minValues.data()) / unit_of(accessor);
  bounds.max = Eigen::Map<const Eigen::Vector3d>(accessor.maxValues.data()) / unit_of(accessor);
  all.push_back(bounds);
}

}  // namespace

std::vector<ShownMesh> shown_meshes(const GltfFile& file) {
  const tinygltf::Model& model = file->model;
  const NodeOrder order = order_nodes(*file, rest_transforms(*file));
  std::vector<ShownMesh> meshes;
  for (std::size_t i = 0; i < order.nodes.size(); ++i) {
    if (i == order.shown && !meshes.empty()) break;
    if (model.nodes[static_cast<std::size_t>(order.nodes[i])].mesh < 0) continue;
    meshes.push_back(mesh_shown_by(*file, order.nodes[i]));
  }
  return meshes;
}

ShownMesh mesh_of_node(const GltfFile& file, const NameOrIndex& node) {
  return mesh_shown_by(*file, choose_mesh_node(*file, {.node = node}, Ambiguity::TakeFirst).node);
}

std::vector<PrimitiveFacts> primitive_facts(const GltfFile& file, int mesh) {
  std::vector<PrimitiveFacts> facts;
  for (const auto& primitive : file->model.meshes[static_cast<std::size_t>(mesh)].primitives) {
    PrimitiveFacts& of_this = facts.emplace_back();
    of_this.material = primitive.material;
    for (const auto& [name, accessor] : primitive.attributes) of_this.attributes.push_back(name);
    std::set<std::string> moved;
    for (const Attributes& target : primitive.targets) {
      for (const auto& [name, accessor] : target) moved.insert(name);
    }
    of_this.target_attributes.assign(moved.begin(), moved.end());
  }
  return facts;
}

MaterialFacts material_facts(const GltfFile& file, int material) {
  const auto& materials = file->model.materials;
  if (material < 0 || static_cast<std::size_t>(material) >= materials.size()) return {};
  const tinygltf::Material& source = materials[static_cast<std::size_t>(material)];
  MaterialFacts facts;
  facts.name = source.name;
  const auto& surface = source.pbrMetallicRoughness;
  if (surface.baseColorFactor.size() == 4) {
    facts.base_colour = Eigen::Map<const Eigen::Vector4d>(surface.baseColorFactor.data());
  }
  facts.metallic = surface.metallicFactor;
  facts.roughness = surface.roughnessFactor;
  if (source.emissiveFactor.size() == 3) {
    facts.emissive = Eigen::Map<const Eigen::Vector3d>(source.emissiveFactor.data());
  }
  facts.alpha_mode = source.alphaMode;
  facts.alpha_cutoff = source.alphaCutoff;
  facts.double_sided = source.doubleSided;
  return facts;
}

std::vector<StatedBounds> stated_bounds(const GltfFile& file, int mesh) {
  std::vector<StatedBounds> all;
  const auto& primitives = file->model.meshes[static_cast<std::size_t>(mesh)].primitives;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    add_bounds(*file, primitives[p].attributes, {p, -1, {}, {}}, all);
    for (std::size_t t = 0; t < primitives[p].targets.size(); ++t) {
      add_bounds(*file, primitives[p].targets[t], {p, static_cast<int>(t), {}, {}}, all);
    }
  }
  return all;
}

}  // namespace morphbake
