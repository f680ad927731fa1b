#include "morphbake/bake/previews.h"

#include <fmt/core.h>

#include <utility>

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

/// A problem that names the file as it will be called, not the staged one.
Problem as_shown(Problem problem, const PreviewPaths& paths) {
  std::string& file = problem.location.file;
  const std::string staged = paths.gltf_file.string();
  if (file.starts_with(staged)) file.replace(0, staged.size(), paths.shown.string());
  if (file.empty()) file = paths.shown.string();
  return problem;
}

std::vector<Image> render(const PreviewPaths& paths, const TurntableOptions& look,
                          const Observer& observer) {
  Observer renaming = observer;
  renaming.on_problem = [&](const Problem& problem) { report(observer, as_shown(problem, paths)); };
  try {
    return render_turntable(
        read_animated_mesh(paths.gltf_file, {.node = paths.node}, paths.animation), look, renaming);
  } catch (const BakeError& error) {
    std::vector<Problem> problems;
    for (const Problem& problem : error.problems()) problems.push_back(as_shown(problem, paths));
    throw BakeError(std::move(problems));
  }
}

fs::path with_suffix(const fs::path& stem, const std::string& suffix) {
  return stem.string() + suffix;
}

}  // namespace

TurntableOptions turntable_of(const PreviewRequest& request, const BakeOptions& options) {
  TurntableOptions look = options.turntable;
  look.threads = options.threads;
  look.width = request.width;
  look.height = request.height;
  look.frames = request.frames;
  return look;
}

std::vector<fs::path> stage_loop(const std::vector<Image>& frames, const fs::path& stem,
                                 const std::vector<PreviewFormat>& formats,
                                 const SheetLayout& sheet, PendingOutputs& outputs) {
  std::vector<fs::path> files;
  for (const PreviewFormat format : formats) {
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
        outputs.stage(files.back(), encode_png(contact_sheet(sheet_pictures(frames), sheet.columns,
                                                             sheet.cell_width)));
        break;
    }
  }
  return files;
}

std::vector<fs::path> stage_previews(const PreviewPaths& paths, const TurntableOptions& look,
                                     const std::vector<PreviewFormat>& formats,
                                     const Observer& observer, PendingOutputs& outputs) {
  return stage_loop(render(paths, look, observer), paths.stem, formats,
                    {.columns = kSheetColumns, .cell_width = look.width / 2}, outputs);
}

std::vector<fs::path> preview(const PreviewPaths& paths, const PreviewRequest& request,
                              const BakeOptions& options, const Observer& observer) {
  PendingOutputs outputs;
  std::vector<fs::path> files =
      stage_previews(paths, turntable_of(request, options), request.formats, observer, outputs);
  outputs.commit();
  return files;
}

}  // namespace morphbake
