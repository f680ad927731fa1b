#pragma once

#include <filesystem>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/files/files.h"
#include "morphbake/preview/turntable.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// Renders what `gltf_file` holds and stages stem.gif, stem.sheet.png and stem.frames/0000.png ...
///
/// @return  the final names of the staged files
std::vector<std::filesystem::path> stage_previews(
    const std::filesystem::path& gltf_file, const PreviewRequest& request, TurntableOptions options,
    const std::filesystem::path& stem, const Observer& observer, PendingOutputs& outputs);

}  // namespace morphbake
