#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/comparison_text.h"
#include "morphbake/bake/compare.h"
#include "morphbake/bake/previews.h"
#include "morphbake/diagnostics/counted.h"

namespace morphbake::cli {
namespace {

constexpr std::size_t kMostCompared = 6;  ///< beside one another they are still seen

constexpr const char* kFooter = R"(
--compare shows all files with one camera, one scale and one clock (the seconds of their
animations; shorter ones stay at their end), standing where their first frames stand. The mix that
it measures against is linear in time: what lies between the first and the last frame of the
file's own animation. A worst volume of -8.10 % at 0.50 s is below that mix by 8.1 % of the first
frame's volume. Edge lengths and dihedral angles are root mean squares over the edges of the
surface, welded as by a bake, so that edges along seams count once. An easing is part of what is
measured; volumes of open surfaces are "open".

Example: morphbake preview morph.glb --size 800x600 --frames 120 --formats gif
         morphbake preview --compare absolute.glb laplacian.glb -o both --formats sheet
         morphbake preview --compare a.glb b.glb --json | jq '.files[].worst.volume')";

struct Arguments {
  std::vector<std::filesystem::path> files;
  bool compare = false;
  bool json = false;
  std::filesystem::path stem;
  std::string node;
  std::string animation;
  LoopArguments loop;
  std::vector<std::string> settings;
};

void check_file_count(const Arguments& arguments) {
  const std::size_t count = arguments.files.size();
  if (!arguments.compare && count > 1) {
    throw usage_error("'" + arguments.files[1].string() + "': preview shows one file",
                      "--compare shows two to six files side by side");
  }
  if (arguments.compare && (count < 2 || count > kMostCompared)) {
    throw usage_error("--compare is given " + counted(static_cast<int>(count), "file", "files"),
                      "name two to six files");
  }
}

/// The stem that was asked for, or the first file's with `suffix`.
std::filesystem::path stem_of(const Arguments& arguments, const char* suffix) {
  if (!arguments.stem.empty()) return arguments.stem;
  return std::filesystem::path(arguments.files[0]).replace_extension() += suffix;
}

void show_one(const Arguments& arguments, Terminal& terminal) {
  const std::filesystem::path& file = arguments.files[0];
  const PreviewRequest request = request_of(arguments.loop);
  const BakeOptions options = read_options("{}", "", arguments.settings);
  for (const std::filesystem::path& picture :
       preview({file, file, stem_of(arguments, ""), name_or_index(arguments.node),
                name_or_index(arguments.animation)},
               request, options, terminal.observer())) {
    terminal.result(picture.string());
  }
}

void show_several(const Arguments& arguments, Terminal& terminal) {
  const PreviewRequest request = request_of(arguments.loop);
  const BakeOptions options = read_options("{}", "", arguments.settings);
  const Comparison comparison =
      compare_morphs({arguments.files, stem_of(arguments, ".compare"),
                      name_or_index(arguments.node), name_or_index(arguments.animation)},
                     request, options, terminal.observer());
  if (arguments.json) return terminal.result(comparison_json(comparison));
  for (const std::filesystem::path& picture : comparison.pictures) {
    terminal.result(picture.string());
  }
  terminal.result("");
  for (const std::string& line : comparison_lines(comparison)) terminal.result(line);
}

void run_preview(const Arguments& arguments, Terminal& terminal) {
  check_file_count(arguments);
  arguments.compare ? show_several(arguments, terminal) : show_one(arguments, terminal);
}

}  // namespace

Command add_preview(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand("preview", "Render the turntable of any morph glTF");
  parser->add_option("FILE", arguments->files, "A .glb or .gltf file; with --compare two to six")
      ->required();
  CLI::Option* compare = parser->add_flag(
      "--compare", arguments->compare,
      "Put several files side by side and tabulate how their volumes, areas, edge lengths and "
      "dihedral angles change");
  parser->add_flag("--json", arguments->json, "What --compare measured as JSON, at more times")
      ->needs(compare);
  parser->add_option("-o,--output", arguments->stem,
                     "Stem of the files to write: STEM.gif, STEM.sheet.png, STEM.frames/ "
                     "(default: the file's own name, with --compare FIRST.compare)");
  add_node(*parser, arguments->node);
  parser->add_option("--animation", arguments->animation,
                     "The animation to play, by its name in the file or its index from 0 "
                     "(default: the last one that moves the mesh's weights)");
  add_loop(*parser, arguments->loop);
  add_settings(*parser, arguments->settings);
  parser->footer(kFooter);
  return {parser, [arguments](Terminal& terminal) { run_preview(*arguments, terminal); }};
}

}  // namespace morphbake::cli
