#include "morphbake/bake/previews.h"

#include <fmt/core.h>

#include "morphbake/bake/bake.h"

namespace morphbake {
namespace fs = std::filesystem;

namespace {

constexpr double kFramesPerSecond = 24;
constexpr int kSheetPictures = 12;
constexpr int kSheetColumns = 4;

/// A dozen pictures, evenly taken from the loop.
std::vector<Image> sheet_pictures(const std::vector<Image>& frames) {
  const int count = std::min(kSheetPictures, static_cast<int>(frames.size()));
  std::vector<Image> chosen;
  for (int i = 0; i < count; ++i) {
    chosen.push_back(
        frames[static_cast<std::size_t>(i) * frames.size() / static_cast<std::size_t>(count)]);
  }
  return chosen;
}

fs::path with_suffix(const fs::path& stem, const std::string& suffix) {
  return stem.string() + suffix;
}

}  // namespace

std::vector<fs::path> stage_previews(const fs::path& gltf_file, const PreviewRequest& request,
                                     TurntableOptions options, const fs::path& stem,
                                     const Observer& observer, PendingOutputs& outputs) {
  options.width = request.width;
  options.height = request.height;
  options.frames = request.frames;
  const std::vector<Image> frames =
      render_turntable(read_animated_mesh(gltf_file), options, observer);
  std::vector<fs::path> files;
  for (const PreviewFormat format : request.formats) {
    switch (format) {
      case PreviewFormat::Png:
        for (std::size_t f = 0; f < frames.size(); ++f) {
          files.push_back(with_suffix(stem, ".frames") / fmt::format("{:04d}.png", f));
          outputs.stage(files.back(), encode_png(frames[f]));
        }
        break;
      case PreviewFormat::Gif:
        files.push_back(with_suffix(stem, ".gif"));
        write_gif(outputs.stage_external(files.back()), frames, kFramesPerSecond);
        break;
      case PreviewFormat::Sheet:
        files.push_back(with_suffix(stem, ".sheet.png"));
        outputs.stage(files.back(), encode_png(contact_sheet(sheet_pictures(frames), kSheetColumns,
                                                             request.width / 2)));
        break;
    }
  }
  return files;
}

std::vector<fs::path> preview(const fs::path& gltf_file, const PreviewRequest& request,
                              const TurntableOptions& options, const fs::path& outputs_stem,
                              const Observer& observer) {
  PendingOutputs outputs;
  std::vector<fs::path> files =
      stage_previews(gltf_file, request, options, outputs_stem, observer, outputs);
  outputs.commit();
  return files;
}

}  // namespace morphbake
