#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/difference_text.h"
#include "morphbake/bake/diff_pictures.h"
#include "morphbake/bake/options.h"
#include "morphbake/bake/previews.h"

namespace morphbake::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter = R"(
Two files are the same when they show the same meshes in the same motion: at every key of either
file and half-way between keys each vertex is where it is in the other, and so are triangles,
attributes, materials, bounds, animations. How a motion is made of targets does not count: "frames"
and "tracks" of one recipe are the same. Between the frames of a file that has a target a frame,
half of how much the motion bends there is let pass.

Exit codes: 0 the same, 1 different, 2 an error. Page: docs/diff.md

Example: morphbake diff golden/morph.glb out/morph.glb
         morphbake diff a.glb b.glb --tolerance 1e-4 --normals 1
         morphbake diff a.glb b.glb --heatmap where.glb --turntable where --formats sheet
         morphbake diff a.glb b.glb --json | jq '.meshes[].clips[].position')";

struct Arguments {
  fs::path first;
  fs::path second;
  std::string node;
  DiffOptions options;
  bool json = false;
  fs::path heat_map;
  fs::path stem;
  LoopArguments loop;
  std::vector<std::string> settings;
};

/// A heat-map in the place of what is compared would be the end of it.
void check_heat_map(const Arguments& arguments) {
  for (const fs::path& file : {arguments.first, arguments.second}) {
    std::error_code error;
    if (!fs::equivalent(file, arguments.heat_map, error)) continue;
    throw usage_error("--heatmap: '" + arguments.heat_map.string() + "' is a file that is compared",
                      "write the heat-map to a file of its own");
  }
}

std::vector<fs::path> write_pictures(const Arguments& arguments, const FileDifference& difference,
                                     const Observer& observer) {
  DiffPictures pictures;
  pictures.heat_map = arguments.heat_map;
  pictures.stem = arguments.stem;
  const PreviewRequest request = request_of(arguments.loop);
  BakeOptions options = read_options("{}", "", arguments.settings);
  options.threads = arguments.options.threads;
  pictures.look = turntable_of(request, options);
  pictures.formats = request.formats;
  PendingOutputs outputs;
  std::vector<fs::path> files = stage_diff_pictures(difference, pictures, observer, outputs);
  outputs.commit();
  return files;
}

bool judge_files(Arguments arguments, Terminal& terminal) {
  if (!arguments.heat_map.empty()) check_heat_map(arguments);
  request_of(arguments.loop);  // what is wrong with it is told before the work
  arguments.options.node = name_or_index(arguments.node);
  const Observer observer = terminal.observer();
  const FileDifference difference =
      diff_files(arguments.first, arguments.second, arguments.options, observer);
  const std::vector<fs::path> pictures = write_pictures(arguments, difference, observer);
  if (arguments.json) {
    terminal.result(difference_json(difference));
  } else {
    for (const fs::path& picture : pictures) terminal.result(picture.string());
    for (const std::string& line : difference_lines(difference)) terminal.result(line);
  }
  return is_same(difference);
}

}  // namespace

Command add_diff(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand(
      "diff", "Tell whether two morph glTF show the same, and where, when and how far not");
  parser->add_option("FIRST", arguments->first, "A .glb or .gltf file")->required();
  parser->add_option("SECOND", arguments->second, "Another one")->required();
  parser->add_option("--node", arguments->node,
                     "The node whose mesh is compared, by its name in both files or its index from "
                     "0 (default: all meshes of the scene)");
  add_tolerances(*parser, arguments->options);
  parser->add_flag("--json", arguments->json, "The same as JSON (schemas/diff.schema.json)");
  parser->add_option("--heatmap", arguments->heat_map,
                     "Write the first file's meshes at rest as a .glb, coloured by the largest "
                     "difference over time: grey none, blue what is allowed, yellow to red more");
  parser->add_option("-o,--turntable", arguments->stem,
                     "Stem of pictures of the worst mesh in these colours: STEM.gif, "
                     "STEM.sheet.png, STEM.frames/");
  add_loop(*parser, arguments->loop);
  add_settings(*parser, arguments->settings);
  parser->footer(kFooter);
  return {
      parser, {}, [arguments](Terminal& terminal) { return judge_files(*arguments, terminal); }};
}

}  // namespace morphbake::cli
