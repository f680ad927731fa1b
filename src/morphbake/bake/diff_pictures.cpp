#include "morphbake/bake/diff_pictures.h"

#include "morphbake/bake/previews.h"
#include "morphbake/diff/heat_map.h"

namespace morphbake {
namespace {

constexpr int kSheetColumns = 4;

}  // namespace

std::vector<std::filesystem::path> stage_diff_pictures(const FileDifference& difference,
                                                       const DiffPictures& pictures,
                                                       const Observer& observer,
                                                       PendingOutputs& outputs) {
  std::vector<std::filesystem::path> files;
  if (difference.meshes.empty()) return files;
  if (!pictures.heat_map.empty()) {
    outputs.stage(pictures.heat_map, heat_map_glb(difference));
    files.push_back(pictures.heat_map);
  }
  if (pictures.stem.empty()) return files;
  const std::vector<Image> loop =
      render_turntable(heat_mesh(difference, worst_mesh(difference)), pictures.look, observer);
  const std::vector<std::filesystem::path> rendered =
      stage_loop(loop, pictures.stem, pictures.formats,
                 {.columns = kSheetColumns, .cell_width = pictures.look.width / 2}, outputs);
  files.insert(files.end(), rendered.begin(), rendered.end());
  return files;
}

}  // namespace morphbake
