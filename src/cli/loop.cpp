#include <charconv>
#include <map>
#include <string_view>

#include "cli/commands.h"

namespace morphbake::cli {
namespace {

const std::map<std::string, PreviewFormat> kFormats = {
    {"png", PreviewFormat::Png}, {"gif", PreviewFormat::Gif}, {"sheet", PreviewFormat::Sheet}};

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

}  // namespace

void add_loop(CLI::App& parser, LoopArguments& loop) {
  parser.add_option("--size", loop.size, "WIDTHxHEIGHT in pixels, of each file")
      ->capture_default_str();
  parser.add_option("--frames", loop.frames, "Pictures in the loop")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  parser.add_option("--formats", loop.formats, "png, gif, sheet, with commas between")
      ->check(CLI::IsMember({"png", "gif", "sheet"}))
      ->delimiter(',')
      ->allow_extra_args(false)  // what follows is a file
      ->capture_default_str();
}

void add_preview_choice(CLI::App& parser, bool& with_previews) {
  parser
      .add_option_function<std::string>(
          "--preview", [&](const std::string& choice) { with_previews = choice != "none"; },
          "`none` leaves the recipe's previews out")
      ->check(CLI::IsMember({"recipe", "none"}))
      ->default_str("recipe");
}

PreviewRequest request_of(const LoopArguments& loop) {
  PreviewRequest request;
  read_size(loop.size, request);
  request.frames = loop.frames;
  for (const std::string& format : loop.formats) request.formats.push_back(kFormats.at(format));
  return request;
}

}  // namespace morphbake::cli
