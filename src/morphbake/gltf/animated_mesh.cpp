#include "morphbake/gltf/animated_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/nodes.h"
#include "morphbake/gltf/source_geometry.h"

namespace morphbake {
namespace {

using Attributes = std::map<std::string, int>;

Float3s read_optional_float3s(const GltfDocument& document, const Attributes& attributes,
                              const std::string& name, const std::string& pointer) {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return {};
  return read_float3s(document, found->second, pointer + "/" + name);
}

Float3s read_colours(const GltfDocument& document, const Attributes& attributes,
                     const std::string& pointer) {
  const auto found = attributes.find("COLOR_0");
  if (found == attributes.end()) return {};
  const std::string place = pointer + "/COLOR_0";
  const int columns = accessor_columns(document, found->second, place) == 4 ? 4 : 3;
  const std::vector<float> values = read_floats(document, found->second, columns, place);
  const auto count = static_cast<Eigen::Index>(values.size()) / columns;
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(values.data(), count, columns).leftCols<3>();
}

Float2s read_texture_coordinates(const GltfDocument& document, const Attributes& attributes,
                                 int set, const std::string& pointer) {
  const std::string name = fmt::format("TEXCOORD_{}", set);
  const auto found = attributes.find(name);
  if (found == attributes.end()) return {};
  const std::vector<float> values = read_floats(document, found->second, 2, pointer + "/" + name);
  return Eigen::Map<const Float2s>(values.data(), static_cast<Eigen::Index>(values.size() / 2), 2);
}

/// Index into mesh.images of a texture's picture, whose bytes are added when new; -1 for none.
/// Which images of the file a mesh uses, each once.
struct UsedImages {
  std::map<int, int> index;        ///< the file's -> one of `bytes`
  std::vector<std::string> bytes;  ///< encoded
  std::vector<std::string> names;  ///< for messages
};

int add_image(const GltfDocument& document, int texture, UsedImages& images) {
  const tinygltf::Model& model = document.model;
  if (texture < 0 || static_cast<std::size_t>(texture) >= model.textures.size()) return -1;
  const int source = model.textures[static_cast<std::size_t>(texture)].source;
  if (source < 0 || static_cast<std::size_t>(source) >= model.images.size()) return -1;
  const auto [entry, is_new] =
      images.index.try_emplace(source, static_cast<int>(images.bytes.size()));
  if (is_new) {
    const auto& bytes = model.images[static_cast<std::size_t>(source)].image;
    images.bytes.emplace_back(bytes.begin(), bytes.end());
    images.names.push_back(fmt::format("{}#/images/{}", document.file.string(), source));
  }
  return entry->second;
}

void read_material(const GltfDocument& document, const tinygltf::Primitive& source,
                   const std::string& pointer, UsedImages& images, AnimatedPrimitive& primitive) {
  const auto& materials = document.model.materials;
  if (source.material < 0 || static_cast<std::size_t>(source.material) >= materials.size()) return;
  const auto& surface = materials[static_cast<std::size_t>(source.material)].pbrMetallicRoughness;
  if (surface.baseColorFactor.size() >= 3) {
    primitive.base_colour =
        Eigen::Map<const Eigen::Vector3d>(surface.baseColorFactor.data()).cast<float>();
  }
  primitive.image = add_image(document, surface.baseColorTexture.index, images);
  if (primitive.image < 0) return;
  primitive.texture_coordinates = read_texture_coordinates(
      document, source.attributes, surface.baseColorTexture.texCoord, pointer + "/attributes");
  if (primitive.texture_coordinates.rows() == 0) primitive.image = -1;
}

void check_rows(const GltfDocument& document, const Float3s& rows, Eigen::Index expected,
                const std::string& pointer) {
  if (rows.rows() == 0 || rows.rows() == expected) return;
  fail_at(document, pointer, "gltf.accessor",
          fmt::format("an attribute has {} elements for {} positions", rows.rows(), expected));
}

AnimatedPrimitive read_primitive(const GltfDocument& document, const tinygltf::Primitive& source,
                                 const std::string& pointer) {
  if ((source.mode != -1 && source.mode != TINYGLTF_MODE_TRIANGLES) || source.indices < 0) {
    fail_at(document, pointer, "gltf.unsupported-primitive",
            "only indexed triangles are supported");
  }
  AnimatedPrimitive primitive;
  primitive.positions =
      read_optional_float3s(document, source.attributes, "POSITION", pointer + "/attributes");
  primitive.normals =
      read_optional_float3s(document, source.attributes, "NORMAL", pointer + "/attributes");
  primitive.colours = read_colours(document, source.attributes, pointer + "/attributes");
  const Eigen::Index count = primitive.positions.rows();
  check_rows(document, primitive.normals, count, pointer + "/attributes/NORMAL");
  check_rows(document, primitive.colours, count, pointer + "/attributes/COLOR_0");
  primitive.triangles = read_triangles(document, source.indices, static_cast<std::size_t>(count),
                                       pointer + "/indices");
  for (std::size_t t = 0; t < source.targets.size(); ++t) {
    const std::string place = fmt::format("{}/targets/{}", pointer, t);
    primitive.target_positions.push_back(
        read_optional_float3s(document, source.targets[t], "POSITION", place));
    primitive.target_normals.push_back(
        read_optional_float3s(document, source.targets[t], "NORMAL", place));
    check_rows(document, primitive.target_positions.back(), count, place + "/POSITION");
    check_rows(document, primitive.target_normals.back(), count, place + "/NORMAL");
  }
  return primitive;
}

std::vector<std::string> read_target_names(const tinygltf::Mesh& mesh, std::size_t count) {
  std::vector<std::string> names(count);
  if (!mesh.extras.IsObject() || !mesh.extras.Has("targetNames")) return names;
  const tinygltf::Value& list = mesh.extras.Get("targetNames");
  if (!list.IsArray()) return names;
  for (std::size_t t = 0; t < std::min(count, list.ArrayLen()); ++t) {
    const tinygltf::Value& name = list.Get(static_cast<int>(t));
    if (name.IsString()) names[t] = name.Get<std::string>();
  }
  return names;
}

void read_rest_weights(const tinygltf::Node& node, const tinygltf::Mesh& source,
                       AnimatedMesh& mesh) {
  const auto count = static_cast<Eigen::Index>(mesh.target_names.size());
  const std::vector<double>& weights = node.weights.empty() ? source.weights : node.weights;
  mesh.key_weights = Eigen::MatrixXf::Zero(1, count);
  const Eigen::Index known = std::min(count, static_cast<Eigen::Index>(weights.size()));
  mesh.key_weights.row(0).head(known) =
      Eigen::Map<const Eigen::RowVectorXd>(weights.data(), known).cast<float>();
}

/// The first animation that moves the weights of `node`.
void read_weights_animation(const GltfDocument& document, int node, AnimatedMesh& mesh) {
  const auto count = static_cast<int>(mesh.target_names.size());
  for (std::size_t a = 0; count > 0 && a < document.model.animations.size(); ++a) {
    const tinygltf::Animation& animation = document.model.animations[a];
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (channel.target_node != node || channel.target_path != "weights") continue;
      const std::string pointer = fmt::format("/animations/{}/samplers/{}", a, channel.sampler);
      if (channel.sampler < 0 ||
          static_cast<std::size_t>(channel.sampler) >= animation.samplers.size()) {
        fail_at(document, pointer, "gltf.invalid", "the sampler does not exist");
      }
      const auto& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
      if (sampler.interpolation != "LINEAR") {
        fail_at(
            document, pointer + "/interpolation", "gltf.unsupported-animation",
            fmt::format("weights with {} interpolation are not supported", sampler.interpolation));
      }
      const std::vector<float> times = read_floats(document, sampler.input, 1, pointer + "/input");
      const std::vector<float> weights =
          read_floats(document, sampler.output, 1, pointer + "/output");
      if (weights.size() != times.size() * static_cast<std::size_t>(count)) {
        fail_at(document, pointer + "/output", "gltf.accessor",
                fmt::format("{} weights for {} keys of {} targets", weights.size(), times.size(),
                            count));
      }
      mesh.key_times = times;
      using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      mesh.key_weights =
          Eigen::Map<const Rows>(weights.data(), static_cast<Eigen::Index>(times.size()), count);
      return;
    }
  }
}

}  // namespace

AnimatedMesh read_animated_mesh(const std::filesystem::path& file) {
  return read_animated_mesh(open_gltf(file));
}

AnimatedMesh read_animated_mesh(const GltfFile& file) {
  const GltfDocument& document = *file;
  const std::vector<MeshNode> nodes = find_mesh_nodes(document);
  const auto& meshes = document.model.meshes;
  if (nodes.empty() || nodes[0].mesh < 0 ||
      static_cast<std::size_t>(nodes[0].mesh) >= meshes.size()) {
    fail_at(document, "/nodes", "gltf.no-mesh", "no node of the scene has a mesh");
  }
  const MeshNode& at = nodes.front();
  const tinygltf::Mesh& source = meshes[static_cast<std::size_t>(at.mesh)];
  AnimatedMesh mesh;
  mesh.to_scene = at.to_scene;
  UsedImages images;
  std::size_t target_count = 0;
  for (std::size_t p = 0; p < source.primitives.size(); ++p) {
    const std::string pointer = primitive_pointer(at.mesh, p);
    mesh.primitives.push_back(read_primitive(document, source.primitives[p], pointer));
    read_material(document, source.primitives[p], pointer, images, mesh.primitives.back());
    target_count = std::max(target_count, source.primitives[p].targets.size());
  }
  mesh.images = std::move(images.bytes);
  mesh.image_names = std::move(images.names);
  mesh.target_names = read_target_names(source, target_count);
  read_rest_weights(document.model.nodes[static_cast<std::size_t>(at.node)], source, mesh);
  read_weights_animation(document, at.node, mesh);
  return mesh;
}

Eigen::VectorXd interpolate_keys(const std::vector<float>& times, const Eigen::MatrixXf& weights,
                                 double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return weights.row(0).cast<double>();
  if (after == times.end()) return weights.row(weights.rows() - 1).cast<double>();
  const Eigen::Index next = after - times.begin();
  const double begin = *(after - 1);
  const double share = (time - begin) / (*after - begin);
  return (1 - share) * weights.row(next - 1).cast<double>() +
         share * weights.row(next).cast<double>();
}

Eigen::VectorXd weights_at(const AnimatedMesh& mesh, double time) {
  return interpolate_keys(mesh.key_times, mesh.key_weights, time);
}

}  // namespace morphbake
