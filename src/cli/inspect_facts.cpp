#include "cli/inspect_facts.h"

#include <algorithm>
#include <cmath>

#include "cli/health_text.h"
#include "morphbake/gltf/mesh_survey.h"
#include "morphbake/json/json.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake::cli {
namespace {

/// The health of the mesh as a source, at rest.
std::variant<MeshHealth, Problem> find_health(const GltfFile& file, int node,
                                              const Observer& observer) {
  try {
    return examine_mesh(read_source("mesh", file, {.node = node}), observer);
  } catch (const BakeError& error) {
    return error.problems().front();
  }
}

/// Adds what the targets of one primitive move, in the scene.
void count_motion(const AnimatedPrimitive& primitive, const Eigen::Matrix3d& to_scene,
                  InspectFacts& facts) {
  std::vector<bool> moves(static_cast<std::size_t>(primitive.positions.rows()), false);
  for (std::size_t k = 0; k < primitive.target_positions.size(); ++k) {
    const Float3s& displacement = primitive.target_positions[k];
    TargetFacts& target = facts.targets[k];
    for (Eigen::Index v = 0; v < displacement.rows(); ++v) {
      const double length = (to_scene * displacement.row(v).cast<double>().transpose()).norm();
      if (length == 0) continue;
      ++target.moving_vertices;
      target.largest_displacement = std::max(target.largest_displacement, length);
      moves[static_cast<std::size_t>(v)] = true;
    }
  }
  facts.moving_vertices += static_cast<int>(std::ranges::count(moves, true));
}

void add_primitives(const AnimatedMesh& mesh, InspectFacts& facts) {
  const Eigen::Affine3d to_scene(mesh.to_scene);
  facts.primitives = mesh.primitives.size();
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    facts.vertices += primitive.positions.rows();
    facts.triangles += primitive.triangles.rows();
    for (Eigen::Index v = 0; v < primitive.positions.rows(); ++v) {
      const Eigen::Vector3d position = primitive.positions.row(v).cast<double>();
      facts.bounds.extend(to_scene * position);
    }
    count_motion(primitive, to_scene.linear(), facts);
  }
}

std::vector<TargetFacts> stored_targets(const MeshSurvey& survey) {
  std::vector<TargetFacts> targets;
  for (const std::string& name : survey.mesh.target_names) targets.push_back({name, 0, 0, 0});
  for (const StoredPrimitive& primitive : survey.primitives) {
    for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
      for (const StoredAttribute& attribute : primitive.targets[t]) {
        targets[t].file_bytes += attribute.accessor.file_bytes;
      }
    }
  }
  return targets;
}

std::vector<WeightsAnimation> animations_of(const MeshSurvey& survey) {
  std::vector<WeightsAnimation> animations;
  for (const WeightsChannel& channel : survey.channels) {
    const std::vector<float>& times = channel.curve.times;
    animations.push_back({channel.animation, channel.animation_name, times.size(),
                          times.empty() ? 0.0 : times.back()});
  }
  return animations;
}

/// @throws BakeError "gltf.no-such-animation"
DrawnWeights chosen_weights(const GltfFile& file, const MeshSurvey& survey,
                            const WeightsRequest& request) {
  if (survey.channels.empty()) {
    throw BakeError(Problem{Severity::Error,
                            "gltf.no-such-animation",
                            {file_of(file), "/animations"},
                            "no animation moves weights of the mesh",
                            "a picture of weights needs one"});
  }
  DrawnWeights drawn{request.picture, survey.channels.back().animation_name, survey.mesh.weights};
  if (!is_chosen(request.animation)) return drawn;
  drawn.curve = read_animated_mesh(file, {.node = survey.mesh.node}, request.animation).weights;
  if (const auto* name = std::get_if<std::string>(&request.animation)) {
    drawn.animation = *name;
    return drawn;
  }
  const int index = std::get<int>(request.animation);
  drawn.animation =
      std::ranges::find(survey.channels, index, &WeightsChannel::animation)->animation_name;
  return drawn;
}

Json to_json(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

Json to_json(const TargetFacts& target) {
  return {{"name", target.name},
          {"moving_vertices", target.moving_vertices},
          {"largest_displacement", target.largest_displacement},
          {"bytes", std::llround(target.file_bytes)}};
}

Json to_json(const WeightsAnimation& animation) {
  return {{"index", animation.index},
          {"name", animation.name},
          {"keys", animation.keys},
          {"duration", animation.duration}};
}

Json to_json(const DrawnWeights& weights) {
  Json json = {{"picture", weights.picture.string()},
               {"animation", weights.animation},
               {"times", weights.curve.times},
               {"values", Json::array()}};
  for (Eigen::Index t = 0; t < weights.curve.values.cols(); ++t) {
    const Eigen::VectorXf values = weights.curve.values.col(t);
    json["values"].push_back(std::vector<float>(values.begin(), values.end()));
  }
  return json;
}

template <typename Items>
Json list_of(const Items& items) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(to_json(item));
  return list;
}

Json health_of(const InspectFacts& facts) {
  if (const auto* health = std::get_if<MeshHealth>(&facts.health)) return health_json(*health);
  const auto& problem = std::get<Problem>(facts.health);
  return {{"not_examined",
           {{"code", problem.code},
            {"pointer", problem.location.pointer},
            {"message", problem.message}}}};
}

double target_bytes(const InspectFacts& facts) {
  double bytes = 0;
  for (const TargetFacts& target : facts.targets) bytes += target.file_bytes;
  return bytes;
}

}  // namespace

InspectFacts inspect_facts(const std::filesystem::path& file, const NameOrIndex& node,
                           const WeightsRequest& weights, const Observer& observer) {
  const GltfFile document = open_gltf(file);
  const MeshSurvey survey = survey_mesh(document, {.node = node});
  InspectFacts facts;
  facts.file = file;
  std::error_code ignored;  // the file was read above
  facts.bytes = std::filesystem::file_size(file, ignored);
  facts.node = survey.mesh.node;
  facts.targets = stored_targets(survey);
  add_primitives(survey.mesh, facts);
  facts.animations = animations_of(survey);
  facts.gpu = gpu_memory(shipped_profiles(), survey.mesh);
  if (!weights.picture.empty()) facts.weights = chosen_weights(document, survey, weights);
  facts.health = find_health(document, survey.mesh.node, observer);
  return facts;
}

double largest_displacement(const InspectFacts& facts) {
  double largest = 0;
  for (const TargetFacts& target : facts.targets) {
    largest = std::max(largest, target.largest_displacement);
  }
  return largest;
}

std::string inspect_json(const InspectFacts& facts) {
  Json json;
  json["file"] = facts.file.string();
  json["bytes"] = facts.bytes;
  json["node"] = facts.node;
  json["primitives"] = facts.primitives;
  json["vertices"] = facts.vertices;
  json["triangles"] = facts.triangles;
  json["targets"] = list_of(facts.targets);
  json["target_bytes"] = std::llround(target_bytes(facts));
  json["moving_vertices"] = facts.moving_vertices;
  json["largest_displacement"] = largest_displacement(facts);
  json["animations"] = list_of(facts.animations);
  json["bounds"]["min"] = to_json(facts.bounds.min());
  json["bounds"]["max"] = to_json(facts.bounds.max());
  json["gpu"] = Json::array();
  for (const GpuMemory& memory : facts.gpu) {
    const auto bytes = std::llround(memory.bytes);
    json["gpu"].push_back({{"profile", memory.profile}, {"bytes", bytes}});
    if (memory.profile == "web-three") json["gpu_bytes"] = bytes;
  }
  if (facts.weights) json["weights"] = to_json(*facts.weights);
  json["health"] = health_of(facts);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace morphbake::cli
