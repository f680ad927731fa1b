#include "morphbake/gltf/mesh_survey.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/animation_curve.h"
#include "morphbake/gltf/nodes.h"
#include "morphbake/gltf/packed_parts.h"
#include "morphbake/gltf/primitive_geometry.h"
#include "morphbake/gltf/size_limits.h"

namespace morphbake {
namespace {

/// Numbers that lie in a bufferView.
struct StoredPart {
  std::size_t view = 0;
  double bytes = 0;  ///< without what a stride adds
};

/// A list of the file as it was stored, before geometry was unpacked.
const Json& stored_list(const GltfDocument& document, const char* name) {
  static const Json none = Json::array();
  const Json& owner = document.packed.is_null() ? document.json : document.packed;
  const auto found = owner.find(name);
  return found == owner.end() ? none : *found;
}

int component_bytes(int type) {
  return std::max(0, tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
}

/// Where an accessor's elements, sparse indices and sparse values lie.
std::vector<StoredPart> parts_of(const Json& stored, const tinygltf::Accessor& accessor) {
  const int columns = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  const double element = 1.0 * component_bytes(accessor.componentType) * columns;
  std::vector<StoredPart> parts;
  const auto add = [&](const Json& owner, double count, double width) {
    const auto view = owner.find("bufferView");
    if (view != owner.end()) parts.push_back({view->get<std::size_t>(), count * width});
  };
  add(stored, static_cast<double>(accessor.count), element);
  const auto sparse = stored.find("sparse");
  if (sparse == stored.end()) return parts;
  const auto count = sparse->at("count").get<double>();
  const Json& indices = sparse->at("indices");
  add(indices, count, component_bytes(indices.at("componentType").get<int>()));
  add(sparse->at("values"), count, element);
  return parts;
}

/// The file's bufferViews: how many bytes each takes, and how many its accessors have.
struct StoredViews {
  std::vector<double> file_bytes;
  std::vector<double> accessor_bytes;
  std::vector<bool> is_meshopt;
  std::vector<std::size_t> strides;
};

StoredViews stored_views(const GltfDocument& document) {
  StoredViews views;
  for (const Json& view : stored_list(document, "bufferViews")) {
    const auto extensions = view.find("extensions");
    const bool is_packed = extensions != view.end() && extensions->contains(kMeshopt);
    const Json& bytes = is_packed ? extensions->at(kMeshopt) : view;
    views.file_bytes.push_back(bytes.at("byteLength").get<double>());
    views.is_meshopt.push_back(is_packed);
    views.strides.push_back(view.value("byteStride", std::size_t{0}));
  }
  views.accessor_bytes.resize(views.file_bytes.size(), 0);
  const Json& accessors = stored_list(document, "accessors");
  for (std::size_t a = 0; a < std::min(accessors.size(), document.model.accessors.size()); ++a) {
    for (const StoredPart& part : parts_of(accessors[a], document.model.accessors[a])) {
      views.accessor_bytes.at(part.view) += part.bytes;
    }
  }
  return views;
}

std::vector<double> declared_bound(const Json& accessor, const char* name) {
  std::vector<double> bound;
  const auto found = accessor.find(name);
  if (found == accessor.end() || !found->is_array()) return bound;
  for (const Json& number : *found) {
    if (number.is_number()) bound.push_back(number.get<double>());
  }
  return bound;
}

/// Reads a mesh's accessors, each once.
class AccessorSurvey {
 public:
  AccessorSurvey(const GltfDocument& document, const StoredViews& views)
      : document_(document), views_(views) {}

  /// @param with_bounds  the numbers are read too
  const StoredAccessor& at(int index, bool with_bounds, const std::string& pointer) {
    const auto [entry, is_new] = accessors_.try_emplace(index);
    StoredAccessor& accessor = entry->second;
    if (is_new) accessor = describe(index, pointer);
    if (with_bounds && accessor.actual_min.empty()) measure(accessor, pointer);
    return accessor;
  }

 private:
  StoredAccessor describe(int index, const std::string& pointer) const {
    StoredAccessor accessor;
    accessor.index = index;
    accessor.count = accessor_count(document_, index, pointer);
    accessor.columns = accessor_columns(document_, index, pointer);
    const auto at = static_cast<std::size_t>(index);
    const tinygltf::Accessor& typed = document_.model.accessors[at];
    accessor.component_type = typed.componentType;
    accessor.is_normalized = typed.normalized;
    const Json& read = document_.json.at("accessors").at(at);
    accessor.declared_min = declared_bound(read, "min");
    accessor.declared_max = declared_bound(read, "max");
    const Json& stored = stored_list(document_, "accessors").at(at);
    accessor.is_sparse = stored.contains("sparse");
    if (stored.contains("bufferView")) {
      accessor.view = stored["bufferView"].get<int>();
      accessor.offset = stored.value("byteOffset", std::size_t{0});
      accessor.stride = views_.strides.at(static_cast<std::size_t>(accessor.view));
    }
    for (const StoredPart& part : parts_of(stored, typed)) {
      const double all = views_.accessor_bytes.at(part.view);
      accessor.is_meshopt = accessor.is_meshopt || views_.is_meshopt.at(part.view);
      if (all > 0) accessor.file_bytes += views_.file_bytes[part.view] * (part.bytes / all);
    }
    return accessor;
  }

  void measure(StoredAccessor& accessor, const std::string& pointer) const {
    using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const std::vector<float> numbers =
        read_floats(document_, accessor.index, accessor.columns, pointer);
    if (numbers.empty()) return;
    const Eigen::Map<const Rows> rows(numbers.data(), static_cast<Eigen::Index>(accessor.count),
                                      accessor.columns);
    for (int c = 0; c < accessor.columns; ++c) {
      accessor.actual_min.push_back(stored_number(accessor, rows.col(c).minCoeff()));
      accessor.actual_max.push_back(stored_number(accessor, rows.col(c).maxCoeff()));
    }
  }

  /// The integer that a normalized number is stored as.
  static double stored_number(const StoredAccessor& accessor, float number) {
    const int bits = 8 * component_bytes(accessor.component_type);
    if (!accessor.is_normalized || accessor.component_type == TINYGLTF_COMPONENT_TYPE_FLOAT) {
      return number;
    }
    const bool is_signed = accessor.component_type == TINYGLTF_COMPONENT_TYPE_BYTE ||
                           accessor.component_type == TINYGLTF_COMPONENT_TYPE_SHORT;
    return std::round(number * (std::exp2(is_signed ? bits - 1 : bits) - 1));
  }

  const GltfDocument& document_;
  const StoredViews& views_;
  std::map<int, StoredAccessor> accessors_;
};

std::vector<StoredAttribute> survey_attributes(const std::map<std::string, int>& attributes,
                                               const std::string& pointer,
                                               AccessorSurvey& accessors) {
  std::vector<StoredAttribute> found;
  for (const auto& [name, accessor] : attributes) {
    const std::string place = child_pointer(pointer, name);
    const bool with_bounds = name == "POSITION" || name == "NORMAL";  // whose size is bounded
    found.push_back({name, place, accessors.at(accessor, with_bounds, place)});
  }
  return found;
}

StoredPrimitive survey_primitive(const tinygltf::Primitive& source, const std::string& pointer,
                                 AccessorSurvey& accessors) {
  StoredPrimitive primitive;
  primitive.pointer = pointer;
  primitive.attributes = survey_attributes(source.attributes, pointer + "/attributes", accessors);
  for (std::size_t t = 0; t < source.targets.size(); ++t) {
    primitive.targets.push_back(
        survey_attributes(source.targets[t], child_pointer(pointer + "/targets", t), accessors));
  }
  return primitive;
}

// Each is looked up among all nodes of the file.
constexpr std::size_t kMostMeshes = 256;

/// Numbers of weights that may still be read.
struct CurveBudget {
  std::size_t left = 0;
};

std::vector<WeightsChannel> survey_channels(const GltfDocument& document, int node, int targets,
                                            AccessorSurvey& accessors, CurveBudget& budget) {
  std::vector<WeightsChannel> channels;
  const auto& animations = document.model.animations;
  for (std::size_t a = 0; targets > 0 && a < animations.size(); ++a) {
    const auto* channel = weights_channel(animations[a], node);
    if (channel == nullptr) continue;
    const int index = static_cast<int>(a);
    const tinygltf::AnimationSampler& sampler =
        animation_sampler(document, index, channel->sampler);
    const std::string pointer = fmt::format("/animations/{}/samplers/{}", a, channel->sampler);
    const std::size_t numbers = accessor_count(document, sampler.input, pointer + "/input") +
                                accessor_count(document, sampler.output, pointer + "/output");
    if (numbers > budget.left) {
      fail_at(document, pointer, "gltf.too-large",
              "the animations ask for more weights than the file's bytes justify",
              "let each animation have keys of its own");
    }
    budget.left -= numbers;
    channels.push_back({index, pointer, animations[a].name,
                        read_curve(document, index, channel->sampler, targets),
                        accessors.at(sampler.input, true, pointer + "/input"),
                        accessors.at(sampler.output, false, pointer + "/output")});
  }
  return channels;
}

std::vector<std::string> extensions_used(const GltfDocument& document) {
  std::vector<std::string> names;
  for (const Json& name : stored_list(document, "extensionsUsed")) {
    if (name.is_string()) names.push_back(name);
  }
  return names;
}

std::optional<std::size_t> name_count(const tinygltf::Mesh& mesh) {
  if (!mesh.extras.IsObject() || !mesh.extras.Has("targetNames")) return std::nullopt;
  const tinygltf::Value& names = mesh.extras.Get("targetNames");
  return names.IsArray() ? names.ArrayLen() : 0;
}

bool has_scale(const GltfDocument& document, int node) {
  const Eigen::Matrix4d local = rest_transforms(document)[static_cast<std::size_t>(node)];
  constexpr double kRounding = 1e-6;  // of rotations written as float32
  return (local.topLeftCorner<3, 3>().colwise().norm().array() - 1).abs().maxCoeff() > kRounding;
}

MeshSurvey survey_node(const GltfFile& file, int node_index, const StoredViews& views,
                       CurveBudget& budget) {
  const GltfDocument& document = *file;
  const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(node_index)];
  const tinygltf::Mesh& mesh = document.model.meshes[static_cast<std::size_t>(node.mesh)];
  MeshSurvey survey;
  survey.mesh = read_animated_mesh(file, {.node = node_index});
  survey.node_name = node.name;
  survey.node_pointer = fmt::format("/nodes/{}", node_index);
  survey.mesh_pointer = fmt::format("/meshes/{}", node.mesh);
  survey.has_children = !node.children.empty();
  survey.has_skin = node.skin >= 0;
  survey.has_scale = has_scale(document, node_index);
  survey.extensions_used = extensions_used(document);
  survey.name_count = name_count(mesh);
  survey.mesh_weights = mesh.weights;
  survey.node_weights = node.weights;
  AccessorSurvey accessors(document, views);
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    survey.primitives.push_back(
        survey_primitive(mesh.primitives[p], primitive_pointer(node.mesh, p), accessors));
  }
  const int targets = static_cast<int>(survey.mesh.target_names.size());
  survey.channels = survey_channels(document, node_index, targets, accessors, budget);
  return survey;
}

/// The first node of each mesh with targets; the first node with a mesh where none has.
std::vector<int> nodes_to_survey(const GltfDocument& document, const MeshChoice& choice) {
  const MeshNode first = choose_mesh_node(document, choice, Ambiguity::TakeFirst);
  if (is_chosen(choice.node)) return {first.node};
  std::vector<int> nodes;
  std::set<int> meshes;
  for (const int node : order_nodes(document, rest_transforms(document)).nodes) {
    const int mesh = document.model.nodes[static_cast<std::size_t>(node)].mesh;
    const bool is_new = mesh >= 0 && meshes.insert(mesh).second;
    if (is_new && target_count(document, mesh) > 0) nodes.push_back(node);
  }
  return nodes.empty() ? std::vector<int>{first.node} : nodes;
}

}  // namespace

MeshSurvey survey_mesh(const GltfFile& file, const MeshChoice& choice) {
  const MeshNode at = choose_mesh_node(*file, choice, Ambiguity::TakeFirst);
  CurveBudget budget{most_curve_numbers(*file)};
  return survey_node(file, at.node, stored_views(*file), budget);
}

std::vector<MeshSurvey> survey_meshes(const GltfFile& file, const MeshChoice& choice) {
  const std::vector<int> nodes = nodes_to_survey(*file, choice);
  std::vector<int> meshes;
  if (nodes.size() > kMostMeshes) {
    fail_at(*file, "/meshes", "gltf.too-large",
            fmt::format("the file has {} meshes with morph targets; at most {} are looked at",
                        nodes.size(), kMostMeshes),
            "choose one by its node (in a command, --node)");
  }
  for (const int node : nodes) {
    meshes.push_back(file->model.nodes[static_cast<std::size_t>(node)].mesh);
  }
  check_mesh_sizes(*file, meshes);
  const StoredViews views = stored_views(*file);
  CurveBudget budget{most_curve_numbers(*file)};
  std::vector<MeshSurvey> surveys;
  for (const int node : nodes) surveys.push_back(survey_node(file, node, views, budget));
  return surveys;
}

}  // namespace morphbake
