#pragma once

#include <filesystem>
#include <vector>

#include "morphbake/bake/options.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/files/files.h"
#include "morphbake/images/images.h"
#include "morphbake/preview/turntable.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// Where pictures come from and go to.
struct PreviewPaths {
  std::filesystem::path gltf_file;
  std::filesystem::path shown;  ///< what messages call that file
  std::filesystem::path stem;   ///< "dir/name"
  NameOrIndex node = {};        ///< whose mesh is shown; none: the first one
  NameOrIndex animation = {};   ///< of its weights; none: the last one
};

/// The look of a recipe's turntable.
TurntableOptions turntable_of(const PreviewRequest& request, const BakeOptions& options);

/// How pictures are put on a contact sheet.
struct SheetLayout {
  int columns = 1;
  int cell_width = 1;  ///< pixels
};

/// Stages stem.gif, stem.sheet.png (a dozen of the pictures) and stem.frames/0000.png ...
///
/// @param frames  of a loop, one or more of one size
/// @return  the final names of the staged files
std::vector<std::filesystem::path> stage_loop(const std::vector<Image>& frames,
                                              const std::filesystem::path& stem,
                                              const std::vector<PreviewFormat>& formats,
                                              const SheetLayout& sheet, PendingOutputs& outputs);

/// Renders what the file holds and stages stem.gif, stem.sheet.png and stem.frames/0000.png ...
///
/// @return  the final names of the staged files
std::vector<std::filesystem::path> stage_previews(const PreviewPaths& paths,
                                                  const TurntableOptions& look,
                                                  const std::vector<PreviewFormat>& formats,
                                                  const Observer& observer,
                                                  PendingOutputs& outputs);

/// Renders the turntable of any morph glTF: stem.gif, stem.sheet.png, stem.frames/0000.png ...
///
/// @return  the files written
std::vector<std::filesystem::path> preview(const PreviewPaths& paths, const PreviewRequest& request,
                                           const BakeOptions& options, const Observer& observer);

}  // namespace morphbake
