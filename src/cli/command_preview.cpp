#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>

#include "cli/commands.h"
#include "morphbake/bake/previews.h"

namespace morphbake::cli {
namespace {

const std::map<std::string, PreviewFormat> kFormats = {
    {"png", PreviewFormat::Png}, {"gif", PreviewFormat::Gif}, {"sheet", PreviewFormat::Sheet}};

struct Arguments {
  std::filesystem::path file;
  std::filesystem::path stem;
  std::string node;
  std::string animation;
  std::string size = "512x512";
  int frames = PreviewRequest{}.frames;
  std::vector<std::string> formats = {"gif", "sheet"};
  std::vector<std::string> settings;
};

/// @return  whether `text` is a whole number of pixels that the renderer takes
bool read_pixels(std::string_view text, int& pixels) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), pixels);
  return error == std::errc() && end == text.data() + text.size() && pixels >= 16 && pixels <= 4096;
}

void read_size(const std::string& text, PreviewRequest& request) {
  const std::size_t cross = text.find('x');
  if (cross != std::string::npos && read_pixels(text.substr(0, cross), request.width) &&
      read_pixels(text.substr(cross + 1), request.height)) {
    return;
  }
  throw usage_error("--size: '" + text + "' is not a size",
                    "write WIDTHxHEIGHT, each 16 to 4096 pixels: 512x512");
}

void run_preview(const Arguments& arguments, Terminal& terminal) {
  PreviewRequest request;
  read_size(arguments.size, request);
  const BakeOptions options = read_options("{}", "", arguments.settings);
  request.frames = arguments.frames;
  for (const std::string& format : arguments.formats) {
    request.formats.push_back(kFormats.at(format));
  }
  std::filesystem::path stem = arguments.stem;
  if (stem.empty()) stem = std::filesystem::path(arguments.file).replace_extension();
  for (const std::filesystem::path& file :
       preview({arguments.file, arguments.file, stem, name_or_index(arguments.node),
                name_or_index(arguments.animation)},
               request, options, terminal.observer())) {
    terminal.result(file.string());
  }
}

}  // namespace

Command add_preview(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand("preview", "Render the turntable of any morph glTF");
  parser->add_option("FILE", arguments->file, "A .glb or .gltf file")->required();
  parser->add_option("-o,--output", arguments->stem,
                     "Stem of the files to write: STEM.gif, STEM.sheet.png, STEM.frames/ "
                     "(default: the file's own name)");
  add_node(*parser, arguments->node);
  parser->add_option("--animation", arguments->animation,
                     "The animation to play, by its name in the file or its index from 0 "
                     "(default: the last one that moves the mesh's weights)");
  parser->add_option("--size", arguments->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  parser->add_option("--frames", arguments->frames, "Pictures in the loop")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  parser->add_option("--formats", arguments->formats, "png, gif, sheet, with commas between")
      ->check(CLI::IsMember({"png", "gif", "sheet"}))
      ->delimiter(',')
      ->capture_default_str();
  add_settings(*parser, arguments->settings);
  parser->footer(
      "\nExample: morphbake preview morph.glb --size 800x600 --frames 120 --formats gif");
  return {parser, [arguments](Terminal& terminal) { run_preview(*arguments, terminal); }};
}

}  // namespace morphbake::cli
