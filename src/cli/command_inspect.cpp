#include <fmt/core.h>

#include <memory>

#include "cli/commands.h"
#include "cli/health_text.h"
#include "cli/inspect_facts.h"
#include "cli/lint_text.h"
#include "morphbake/diagnostics/counted.h"
#include "morphbake/diagnostics/shown_text.h"
#include "morphbake/files/files.h"
#include "morphbake/preview/weights_picture.h"

namespace morphbake::cli {
namespace {

struct Arguments {
  std::filesystem::path file;
  std::string node;
  std::filesystem::path picture;
  std::string animation;
  bool json = false;
};

std::string name_shown(const std::string& name) {
  return name.empty() ? "(no name)" : without_control_characters(name);
}

void add_motion(const InspectFacts& facts, std::vector<std::string>& lines) {
  lines.push_back(fmt::format("motion      {} vertices move, by {:.4g} at most",
                              facts.moving_vertices, largest_displacement(facts)));
  lines.push_back(fmt::format("animations  {}", facts.animations.size()));
  for (const WeightsAnimation& animation : facts.animations) {
    lines.push_back(fmt::format("  {:<24} {:8} keys, {:.4g} s", name_shown(animation.name),
                                animation.keys, animation.duration));
  }
}

void add_targets(const InspectFacts& facts, std::vector<std::string>& lines) {
  double bytes = 0;
  for (const TargetFacts& target : facts.targets) bytes += target.file_bytes;
  if (!facts.targets.empty()) lines.push_back("GPU         targets: " + shown_memory(facts.gpu));
  lines.push_back(
      fmt::format("targets     {}, {} in the file", facts.targets.size(), shown_bytes(bytes)));
  for (const TargetFacts& target : facts.targets) {
    lines.push_back(fmt::format("  {:<24} {:8} vertices, by {:.4g} at most, {}",
                                name_shown(target.name), target.moving_vertices,
                                target.largest_displacement, shown_bytes(target.file_bytes)));
  }
}

std::vector<std::string> lines_of(const InspectFacts& facts) {
  const Eigen::Vector3d low = facts.bounds.min();
  const Eigen::Vector3d high = facts.bounds.max();
  std::vector<std::string> lines = {
      fmt::format("file        {} ({} bytes)", facts.file.string(), facts.bytes),
      fmt::format("mesh        of node {}: {}, {} vertices, {} triangles", facts.node,
                  counted(static_cast<int>(facts.primitives), "primitive", "primitives"),
                  facts.vertices, facts.triangles),
      fmt::format("bounds      ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})", low.x(),
                  low.y(), low.z(), high.x(), high.y(), high.z())};
  add_motion(facts, lines);
  add_targets(facts, lines);
  if (facts.weights) lines.push_back("weights     " + facts.weights->picture.string());
  if (const auto* health = std::get_if<MeshHealth>(&facts.health)) {
    for (const std::string& line : health_lines(*health)) lines.push_back(line);
  } else {
    const auto& problem = std::get<Problem>(facts.health);
    lines.push_back(
        fmt::format("health      not examined: {} [{}]", problem.message, problem.code));
  }
  return lines;
}

void write_picture(const InspectFacts& facts) {
  std::vector<std::string> names;
  for (const TargetFacts& target : facts.targets) names.push_back(target.name);
  const std::string animation =
      facts.weights->animation.empty() ? "" : fmt::format(" of \"{}\"", facts.weights->animation);
  const std::string title =
      fmt::format("weights{} in {}", animation, facts.file.filename().string());
  PendingOutputs outputs;
  outputs.stage(facts.weights->picture,
                encode_png(draw_weights(facts.weights->curve, names, title)));
  outputs.commit();
}

void run_inspect(const Arguments& arguments, Terminal& terminal) {
  if (arguments.picture.empty() && !arguments.animation.empty()) {
    throw usage_error("--animation chooses what --weights draws, which is not there",
                      "add --weights FILE.png");
  }
  const InspectFacts facts =
      inspect_facts(arguments.file, name_or_index(arguments.node),
                    {arguments.picture, name_or_index(arguments.animation)}, terminal.observer());
  if (facts.weights) write_picture(facts);
  if (arguments.json) return terminal.result(inspect_json(facts));
  for (const std::string& line : lines_of(facts)) terminal.result(line);
}

}  // namespace

Command add_inspect(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand(
      "inspect", "Show the targets, sizes, bounds and mesh health of a glTF");
  parser->add_option("FILE", arguments->file, "A .glb or .gltf file")->required();
  add_node(*parser, arguments->node);
  parser->add_option("--weights", arguments->picture,
                     "Draw the weights over time into this .png: a strip a target");
  parser->add_option("--animation", arguments->animation,
                     "The animation that --weights draws, by its name in the file or its index "
                     "from 0 (default: the last one that moves the weights)");
  parser->add_flag("--json", arguments->json, "The same as JSON, with the weights that are drawn");
  parser->footer(
      "\nA target's bytes are those of its accessors in the file, compressed where they are; on "
      "the\n"
      "GPU it takes what each engine makes of it (morphbake lint --list).\n"
      "\nHealth is what a bake mends, warns of or refuses in the mesh; looking through a million\n"
      "triangles takes some seconds.\n"
      "\nExample: morphbake inspect morph.glb --json\n"
      "         morphbake inspect morph.glb --weights weights.png");
  return {parser, [arguments](Terminal& terminal) { run_inspect(*arguments, terminal); }};
}

}  // namespace morphbake::cli
