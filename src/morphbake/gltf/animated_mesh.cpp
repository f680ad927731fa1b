#include "morphbake/gltf/animated_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/animation_curve.h"
#include "morphbake/gltf/names.h"
#include "morphbake/gltf/nodes.h"
#include "morphbake/gltf/primitive_geometry.h"
#include "morphbake/gltf/resources.h"
#include "morphbake/gltf/size_limits.h"

namespace morphbake {
namespace {

using Attributes = std::map<std::string, int>;

Float3s read_colours(const GltfDocument& document, const Attributes& attributes,
                     Eigen::Index vertices, const std::string& pointer) {
  const auto found = attributes.find("COLOR_0");
  if (found == attributes.end()) return {};
  const std::string place = pointer + "/COLOR_0";
  check_count(document, found->second, static_cast<std::size_t>(vertices), place);
  const int columns = accessor_columns(document, found->second, place) == 4 ? 4 : 3;
  const std::vector<float> values = read_floats(document, found->second, columns, place);
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(values.data(), vertices, columns).leftCols<3>();
}

Float2s read_texture_coordinates(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                 int set, Eigen::Index vertices, const std::string& pointer) {
  const std::string name = fmt::format("TEXCOORD_{}", set);
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return {};
  const std::string place = fmt::format("{}/attributes/{}", pointer, name);
  check_count(document, found->second, static_cast<std::size_t>(vertices), place);
  return read_float2s(document, found->second, place);
}

/// A number of a texture's transform, `otherwise` where it says nothing.
double number_or(const tinygltf::Value& value, double otherwise) {
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

Eigen::Vector2d pair_or(const tinygltf::Value& value, const Eigen::Vector2d& otherwise) {
  if (!value.IsArray() || value.ArrayLen() != 2) return otherwise;
  return {number_or(value.Get(0), otherwise.x()), number_or(value.Get(1), otherwise.y())};
}

/// Where a texture's coordinates come from, and what is done to them.
struct TexturePlacement {
  int set = 0;
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
};

/// KHR_texture_transform: translation * rotation * scale.
TexturePlacement placement_of(const tinygltf::TextureInfo& texture) {
  TexturePlacement placement;
  placement.set = texture.texCoord;
  const auto found = texture.extensions.find("KHR_texture_transform");
  if (found == texture.extensions.end() || !found->second.IsObject()) return placement;
  const tinygltf::Value& transform = found->second;
  const double angle = number_or(transform.Get("rotation"), 0);
  const Eigen::Vector2d scale = pair_or(transform.Get("scale"), Eigen::Vector2d::Ones());
  Eigen::Matrix2d rotation;
  rotation << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
  placement.linear = rotation * scale.asDiagonal();
  placement.offset = pair_or(transform.Get("offset"), Eigen::Vector2d::Zero());
  if (const tinygltf::Value& set = transform.Get("texCoord"); set.IsInt()) {
    placement.set = set.GetNumberAsInt();
  }
  return placement;
}

Float2s placed(const Float2s& coordinates, const TexturePlacement& placement) {
  const bool stays = placement.linear.isIdentity(0) && placement.offset.isZero(0);
  if (stays) return coordinates;
  const Eigen::Matrix2f turned = placement.linear.transpose().cast<float>();
  return (coordinates * turned).rowwise() + placement.offset.transpose().cast<float>();
}

/// Which images of the file a mesh uses, each once.
struct UsedImages {
  std::map<int, int> index;        ///< the file's -> one of `bytes`
  std::vector<std::string> bytes;  ///< encoded
  std::vector<std::string> names;  ///< for messages
};

/// Index of a texture's picture, whose bytes are added when new; -1 for none.
int add_image(const GltfDocument& document, int texture, UsedImages& images) {
  const tinygltf::Model& model = document.model;
  if (texture < 0 || static_cast<std::size_t>(texture) >= model.textures.size()) return -1;
  const int source = model.textures[static_cast<std::size_t>(texture)].source;
  if (source < 0 || static_cast<std::size_t>(source) >= model.images.size()) return -1;
  const auto [entry, is_new] =
      images.index.try_emplace(source, static_cast<int>(images.bytes.size()));
  if (is_new) {
    images.bytes.emplace_back(image_bytes(document, static_cast<std::size_t>(source)));
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
  const TexturePlacement placement = placement_of(surface.baseColorTexture);
  primitive.texture_coordinates =
      placed(read_texture_coordinates(document, source, placement.set, primitive.positions.rows(),
                                      pointer),
             placement);
  if (primitive.texture_coordinates.rows() == 0) primitive.image = -1;
}

AnimatedPrimitive read_primitive(const GltfDocument& document, const tinygltf::Primitive& source,
                                 const std::string& pointer) {
  PrimitiveGeometry geometry = read_primitive_geometry(document, source, pointer);
  AnimatedPrimitive primitive;
  primitive.positions = std::move(geometry.positions);
  primitive.normals = std::move(geometry.normals);
  primitive.triangles = std::move(geometry.triangles);
  const Eigen::Index vertices = primitive.positions.rows();
  primitive.colours = read_colours(document, source.attributes, vertices, pointer + "/attributes");
  for (std::size_t t = 0; t < source.targets.size(); ++t) {
    TargetGeometry target = read_target(document, source, t, vertices, pointer);
    primitive.target_positions.push_back(std::move(target.positions));
    primitive.target_normals.push_back(std::move(target.normals));
    primitive.target_colours.push_back(read_colours(document, source.targets[t], vertices,
                                                    fmt::format("{}/targets/{}", pointer, t)));
  }
  return primitive;
}

/// The weights at rest, at all times.
AnimationCurve constant_weights(const Eigen::VectorXd& rest) {
  AnimationCurve curve;
  curve.values = rest.transpose().cast<float>();
  return curve;
}

/// The first channel of an animation that moves the weights of `node`, or none.
const tinygltf::AnimationChannel* weights_channel(const tinygltf::Animation& animation, int node) {
  const auto found =
      std::ranges::find_if(animation.channels, [node](const tinygltf::AnimationChannel& channel) {
        return channel.target_node == node && channel.target_path == "weights";
      });
  return found == animation.channels.end() ? nullptr : &*found;
}

/// The last animations that move the weights of `node`, in their order: a bake appends its own to
/// those of the source.
std::vector<AnimationCurve> last_weights(const GltfDocument& document, int node, int targets,
                                         std::size_t most) {
  std::vector<AnimationCurve> curves;
  for (std::size_t a = document.model.animations.size(); targets > 0 && a-- > 0;) {
    if (curves.size() == most) break;
    const auto* channel = weights_channel(document.model.animations[a], node);
    if (channel == nullptr) continue;
    curves.push_back(read_curve(document, static_cast<int>(a), channel->sampler, targets));
  }
  std::ranges::reverse(curves);
  return curves;
}

AnimationCurve chosen_weights(const GltfDocument& document, int node, int targets,
                              const NameOrIndex& choice) {
  const auto& animations = document.model.animations;
  const int index =
      index_of_choice(document, choice, names_of(animations), "animation", "/animations");
  const auto* channel = weights_channel(animations[static_cast<std::size_t>(index)], node);
  if (channel != nullptr && targets > 0) {
    return read_curve(document, index, channel->sampler, targets);
  }
  fail_at(document, child_pointer("/animations", static_cast<std::size_t>(index)),
          "gltf.no-such-animation", fmt::format("the animation moves no weights of node {}", node),
          "`morphbake inspect` lists those that do");
}

WrittenMesh read_mesh(const GltfDocument& document, const MeshNode& at, std::size_t clips) {
  const tinygltf::Mesh& source = document.model.meshes[static_cast<std::size_t>(at.mesh)];
  const std::size_t targets = target_count(document, at.mesh);
  AnimatedMesh mesh;
  mesh.node = at.node;
  mesh.to_scene = at.to_scene;
  UsedImages images;
  for (std::size_t p = 0; p < source.primitives.size(); ++p) {
    const std::string pointer = primitive_pointer(at.mesh, p);
    mesh.primitives.push_back(read_primitive(document, source.primitives[p], pointer));
    read_material(document, source.primitives[p], pointer, images, mesh.primitives.back());
  }
  mesh.images = std::move(images.bytes);
  mesh.image_names = std::move(images.names);
  mesh.target_names = target_names(source, targets);
  const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(at.node)];
  const Eigen::VectorXd rest = rest_weights(node, source, targets);
  std::vector<AnimationCurve> curves =
      last_weights(document, at.node, static_cast<int>(rest.size()), clips);
  if (curves.empty()) curves.push_back(constant_weights(rest));
  mesh.weights = curves.back();
  return {std::move(mesh), std::move(curves)};
}

}  // namespace

AnimatedMesh read_animated_mesh(const std::filesystem::path& file, const MeshChoice& choice,
                                const NameOrIndex& animation) {
  return read_animated_mesh(open_gltf(file), choice, animation);
}

AnimatedMesh read_animated_mesh(const GltfFile& file, const MeshChoice& choice,
                                const NameOrIndex& animation) {
  const MeshNode at = choose_mesh_node(*file, choice, Ambiguity::TakeFirst);
  check_mesh_size(*file, at.mesh);
  AnimatedMesh mesh = read_mesh(*file, at, is_chosen(animation) ? 0 : 1).mesh;
  if (is_chosen(animation)) {
    const auto targets = static_cast<int>(mesh.weights.values.cols());
    mesh.weights = chosen_weights(*file, at.node, targets, animation);
  }
  return mesh;
}

std::vector<WeightsAnimation> weights_animations(const GltfFile& file, int node) {
  std::vector<WeightsAnimation> found;
  std::map<int, WeightsAnimation> by_input;  // keys that many animations may share
  const auto& animations = file->model.animations;
  for (std::size_t a = 0; a < animations.size(); ++a) {
    const auto* channel = weights_channel(animations[a], node);
    if (channel == nullptr) continue;
    const std::string pointer = child_pointer("/animations", a) + "/samplers";
    const int input = animation_sampler(*file, static_cast<int>(a), channel->sampler).input;
    const auto [entry, is_new] = by_input.try_emplace(input);
    if (is_new) {
      const std::vector<float> times = read_floats(*file, input, 1, pointer);
      entry->second.keys = times.size();
      entry->second.duration = times.empty() ? 0 : times.back();
    }
    WeightsAnimation& animation = found.emplace_back(entry->second);
    animation.index = static_cast<int>(a);
    animation.name = animations[a].name;
  }
  return found;
}

WrittenMesh read_written_mesh(const std::string& glb, const std::filesystem::path& name, int node,
                              std::size_t clips) {
  const GltfFile file = open_gltf_bytes(glb, name);
  return read_mesh(*file, choose_mesh_node(*file, {.node = node}, Ambiguity::TakeFirst), clips);
}

Eigen::VectorXd interpolate_keys(const std::vector<float>& times, const Eigen::MatrixXf& weights,
                                 double time) {
  return value_at({times, weights, Interpolation::Linear, {}, {}}, time);
}

Eigen::VectorXd weights_at(const AnimatedMesh& mesh, double time) {
  return value_at(mesh.weights, time);
}

}  // namespace morphbake
