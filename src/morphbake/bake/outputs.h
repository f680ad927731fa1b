#pragma once

#include "morphbake/bake/bake.h"
#include "morphbake/bake/solved_recipe.h"
#include "morphbake/files/files.h"

namespace morphbake {

/// An output that waits to be committed.
struct StagedOutput {
  OutputReport report;
  std::filesystem::path file;  ///< the temporary one
  int node = 0;                ///< of the file: that shows the morph
};

/// Reduces, writes and measures one output.
///
/// @throws BakeError "export.normal-error" when a bound on normals is not kept and shall be
StagedOutput stage_output(const SolvedRecipe& solved, std::size_t index, const BakeOptions& options,
                          const Observer& observer, PendingOutputs& outputs);

}  // namespace morphbake
