#pragma once

#include <filesystem>
#include <vector>

#include "morphbake/diff/file_difference.h"
#include "morphbake/files/files.h"
#include "morphbake/preview/turntable.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// What is to show where two files differ, and where it goes; what has no path is not made.
struct DiffPictures {
  std::filesystem::path heat_map;  ///< a .glb: see heat_map_glb
  std::filesystem::path stem;      ///< of the turntable of the worst mesh in its heat colours
  TurntableOptions look = {};
  std::vector<PreviewFormat> formats = {};
};

/// Stages them; nothing when no mesh could be compared.
///
/// @return  the final names of the staged files
/// @throws BakeError as heat_map_glb and render_turntable, "output.unwritable"; Cancelled
std::vector<std::filesystem::path> stage_diff_pictures(const FileDifference& difference,
                                                       const DiffPictures& pictures,
                                                       const Observer& observer,
                                                       PendingOutputs& outputs);

}  // namespace morphbake
