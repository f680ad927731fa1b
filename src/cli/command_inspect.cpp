#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <variant>

#include "cli/commands.h"
#include "cli/health_text.h"
#include "morphbake/connectivity/mesh_health.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/json/json.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake::cli {
namespace {

struct TargetFacts {
  std::string name;
  int moving_vertices = 0;
  double largest_displacement = 0;  ///< mesh units
};

struct Facts {
  std::filesystem::path file;
  std::uintmax_t bytes = 0;
  std::size_t primitives = 0;
  Eigen::Index vertices = 0;
  int node = 0;
  Eigen::Index triangles = 0;
  std::vector<TargetFacts> targets;
  int moving_vertices = 0;  ///< by any target
  std::vector<WeightsAnimation> animations;
  Eigen::AlignedBox3d bounds;                ///< of the base shape in the scene
  Eigen::Index gpu_bytes = 0;                ///< of the targets' texture in three.js
  std::variant<MeshHealth, Problem> health;  ///< or why the mesh can be no source
};

/// The health of the mesh as a source, at rest.
std::variant<MeshHealth, Problem> find_health(const GltfFile& file, int node,
                                              const Observer& observer) {
  try {
    return examine_mesh(read_source("mesh", file, {.node = node}), observer);
  } catch (const BakeError& error) {
    return error.problems().front();
  }
}

/// Adds what the targets of one primitive move.
void count_motion(const AnimatedPrimitive& primitive, Facts& facts) {
  std::vector<bool> moves(static_cast<std::size_t>(primitive.positions.rows()), false);
  for (std::size_t k = 0; k < primitive.target_positions.size(); ++k) {
    const Float3s& displacement = primitive.target_positions[k];
    if (k >= facts.targets.size()) facts.targets.resize(k + 1);
    TargetFacts& target = facts.targets[k];
    for (Eigen::Index v = 0; v < displacement.rows(); ++v) {
      const double length = displacement.row(v).cast<double>().norm();
      if (length == 0) continue;
      ++target.moving_vertices;
      target.largest_displacement = std::max(target.largest_displacement, length);
      moves[static_cast<std::size_t>(v)] = true;
    }
  }
  for (const bool does_move : moves) facts.moving_vertices += does_move ? 1 : 0;
}

Facts find_facts(const std::filesystem::path& file, const NameOrIndex& node,
                 const Observer& observer) {
  const GltfFile document = open_gltf(file);
  const AnimatedMesh mesh = read_animated_mesh(document, {.node = node});
  Facts facts;
  facts.node = mesh.node;
  facts.health = find_health(document, mesh.node, observer);
  facts.file = file;
  std::error_code ignored;  // the file was read above
  facts.bytes = std::filesystem::file_size(file, ignored);
  facts.primitives = mesh.primitives.size();
  facts.targets.resize(mesh.target_names.size());
  const Eigen::Affine3d to_scene(mesh.to_scene);
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    const Eigen::Index count = primitive.positions.rows();
    facts.vertices += count;
    facts.triangles += primitive.triangles.rows();
    for (Eigen::Index v = 0; v < count; ++v) {
      const Eigen::Vector3d position = primitive.positions.row(v).cast<double>();
      facts.bounds.extend(to_scene * position);
    }
    count_motion(primitive, facts);
    // three.js keeps a texel of four floats a vertex and target, and another one for its normal.
    const Eigen::Index texel_bytes = primitive.target_normals.empty() ? 16 : 32;
    facts.gpu_bytes +=
        texel_bytes * count * static_cast<Eigen::Index>(primitive.target_positions.size());
  }
  for (std::size_t k = 0; k < mesh.target_names.size(); ++k) {
    facts.targets[k].name = mesh.target_names[k];
  }
  facts.animations = weights_animations(document, mesh.node);
  return facts;
}

double largest_displacement(const Facts& facts) {
  double largest = 0;
  for (const TargetFacts& target : facts.targets) {
    largest = std::max(largest, target.largest_displacement);
  }
  return largest;
}

Json to_json(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

std::string as_json(const Facts& facts) {
  Json targets = Json::array();
  for (const TargetFacts& target : facts.targets) {
    Json entry;
    entry["name"] = target.name;
    entry["moving_vertices"] = target.moving_vertices;
    entry["largest_displacement"] = target.largest_displacement;
    targets.push_back(entry);
  }
  Json json;
  json["file"] = facts.file.string();
  json["bytes"] = facts.bytes;
  json["node"] = facts.node;
  json["primitives"] = facts.primitives;
  json["vertices"] = facts.vertices;
  json["triangles"] = facts.triangles;
  json["targets"] = targets;
  json["moving_vertices"] = facts.moving_vertices;
  json["largest_displacement"] = largest_displacement(facts);
  json["animations"] = Json::array();
  for (const WeightsAnimation& animation : facts.animations) {
    Json entry;
    entry["index"] = animation.index;
    entry["name"] = animation.name;
    entry["keys"] = animation.keys;
    entry["duration"] = animation.duration;
    json["animations"].push_back(entry);
  }
  json["bounds"]["min"] = to_json(facts.bounds.min());
  json["bounds"]["max"] = to_json(facts.bounds.max());
  json["gpu_bytes"] = facts.gpu_bytes;
  if (const auto* health = std::get_if<MeshHealth>(&facts.health)) {
    json["health"] = health_json(*health);
  } else {
    const auto& problem = std::get<Problem>(facts.health);
    json["health"]["not_examined"] = {{"code", problem.code},
                                      {"pointer", problem.location.pointer},
                                      {"message", problem.message}};
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string name_shown(const std::string& name) { return name.empty() ? "(no name)" : name; }

void print_facts(const Facts& facts, Terminal& terminal) {
  const Eigen::Vector3d low = facts.bounds.min();
  const Eigen::Vector3d high = facts.bounds.max();
  terminal.result(fmt::format("file        {} ({} bytes)", facts.file.string(), facts.bytes));
  terminal.result(fmt::format("mesh        of node {}: {} primitives, {} vertices, {} triangles",
                              facts.node, facts.primitives, facts.vertices, facts.triangles));
  terminal.result(fmt::format("bounds      ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})",
                              low.x(), low.y(), low.z(), high.x(), high.y(), high.z()));
  terminal.result(fmt::format("motion      {} vertices move, by {:.4g} at most",
                              facts.moving_vertices, largest_displacement(facts)));
  terminal.result(fmt::format("animations  {}", facts.animations.size()));
  for (const WeightsAnimation& animation : facts.animations) {
    terminal.result(fmt::format("  {:<24} {:8} keys, {:.4g} s", name_shown(animation.name),
                                animation.keys, animation.duration));
  }
  terminal.result(fmt::format("GPU         {} bytes for the targets in three.js", facts.gpu_bytes));
  terminal.result(fmt::format("targets     {}", facts.targets.size()));
  for (const TargetFacts& target : facts.targets) {
    terminal.result(fmt::format("  {:<24} {:8} vertices, by {:.4g} at most",
                                name_shown(target.name), target.moving_vertices,
                                target.largest_displacement));
  }
  if (const auto* health = std::get_if<MeshHealth>(&facts.health)) {
    for (const std::string& line : health_lines(*health)) terminal.result(line);
  } else {
    const auto& problem = std::get<Problem>(facts.health);
    terminal.result(
        fmt::format("health      not examined: {} [{}]", problem.message, problem.code));
  }
}

}  // namespace

Command add_inspect(CLI::App& program) {
  struct Arguments {
    std::filesystem::path file;
    std::string node;
    bool json = false;
  };

  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand(
      "inspect", "Show the targets, sizes, bounds and mesh health of a glTF");
  parser->add_option("FILE", arguments->file, "A .glb or .gltf file")->required();
  add_node(*parser, arguments->node);
  parser->add_flag("--json", arguments->json, "The same as JSON");
  parser->footer(
      "\nHealth is what a bake mends, warns of or refuses in the mesh; looking through a million\n"
      "triangles takes some seconds.\n"
      "\nExample: morphbake inspect morph.glb --json");
  return {parser, [arguments](Terminal& terminal) {
            const Facts facts =
                find_facts(arguments->file, name_or_index(arguments->node), terminal.observer());
            if (arguments->json) return terminal.result(as_json(facts));
            print_facts(facts, terminal);
          }};
}

}  // namespace morphbake::cli
