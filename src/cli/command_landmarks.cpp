#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "morphbake/bake/landmark_files.h"
#include "morphbake/recipe/read_landmarks.h"

namespace morphbake::cli {
namespace {

constexpr const char* kFooter = R"(
Landmarks are named points of a source: the same names on two sources say what corresponds.
`suggest` proposes them, you look at the sheet and move what is wrong, `show` renders it again.

Example: morphbake landmarks suggest cow.glb giraffe.glb
         morphbake landmarks show giraffe.glb)";

constexpr const char* kSuggestFooter = R"(
Writes A.landmarks.json and B.landmarks.json beside the sources, where recipes find them, and
A-B.landmarks.png: both shapes with numbered dots. Tips of ears, legs, tails and the like come
first (tip_1; tip_2_left and tip_2_right), then rims of open shapes, then points far from the rest.
Rename them as you like, alike in both files.

Example: morphbake landmarks suggest cow.glb giraffe.glb --count 14 --output-dir landmarks)";

constexpr const char* kShowFooter = R"(
Example: morphbake landmarks show giraffe.glb --landmarks other.json -o giraffe.png)";

struct ShowArguments {
  std::filesystem::path file;
  std::filesystem::path landmarks;
  std::filesystem::path picture;
  int threads = 0;
};

void add_threads(CLI::App& parser, int& threads) {
  parser.add_option("--threads", threads, "0: all cores; changes the time, never a byte")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

CLI::App* add_suggest(CLI::App& parent, LandmarkRequest& request) {
  CLI::App* parser = parent.add_subcommand(
      "suggest", "Propose landmarks for two shapes; prints the files it wrote");
  parser->add_option("A", request.a, "A .glb or .gltf file")->required();
  parser->add_option("B", request.b, "Another one")->required();
  parser->add_option("--count", request.count, "How many landmarks are wanted")
      ->check(CLI::Range(3, 100))
      ->capture_default_str();
  parser->add_option("-o,--output-dir", request.folder,
                     "Write all files into this folder instead of beside the sources");
  parser->add_flag("--force", request.replace, "Overwrite files that exist");
  add_threads(*parser, request.threads);
  parser->footer(kSuggestFooter);
  return parser;
}

CLI::App* add_show(CLI::App& parent, ShowArguments& arguments) {
  CLI::App* parser = parent.add_subcommand("show", "Render the landmarks of a file on its shape");
  parser->add_option("FILE", arguments.file, "A .glb or .gltf file")->required();
  parser->add_option("--landmarks", arguments.landmarks,
                     "The landmark file (default: FILE.landmarks.json beside it)");
  parser->add_option("-o,--output", arguments.picture,
                     "The picture to write (default: FILE.landmarks.png beside it)");
  add_threads(*parser, arguments.threads);
  parser->footer(kShowFooter);
  return parser;
}

void run_show(const ShowArguments& arguments, Terminal& terminal) {
  std::filesystem::path picture = arguments.picture;
  if (picture.empty()) picture = landmarks_beside(arguments.file).replace_extension(".png");
  write_landmark_sheet(arguments.file, arguments.landmarks, picture, arguments.threads,
                       terminal.observer());
  terminal.result(picture.string());
}

void run_suggest(LandmarkRequest request, Terminal& terminal) {
  request.schema = shipped_schema_file("landmarks.schema.json");
  for (const std::filesystem::path& file :
       write_suggested_landmarks(request, terminal.observer())) {
    terminal.result(file.string());
  }
  terminal.note("next: look at the picture, and move what is wrong in the landmark files");
}

}  // namespace

Command add_landmarks(CLI::App& program) {
  auto request = std::make_shared<LandmarkRequest>();
  auto arguments = std::make_shared<ShowArguments>();
  CLI::App* parser =
      program.add_subcommand("landmarks", "Propose corresponding points, or show those of a file");
  parser->require_subcommand(1);
  parser->fallthrough();
  const CLI::App* suggest = add_suggest(*parser, *request);
  add_show(*parser, *arguments);
  parser->footer(kFooter);
  return {parser, [suggest, request, arguments](Terminal& terminal) {
            if (suggest->parsed()) return run_suggest(*request, terminal);
            run_show(*arguments, terminal);
          }};
}

}  // namespace morphbake::cli
