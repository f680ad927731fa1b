#pragma once

#include <string>

#include "morphbake/bake/bake.h"
#include "morphbake/bake/solved_recipe.h"

namespace morphbake {

/// An output before it is a file.
struct BakedOutput {
  OutputReport report;  ///< without previews
  std::string glb;      ///< bytes of the file
  int node = 0;         ///< of the file: that shows the morph
};

/// Reduces, writes and measures one output.
///
/// @throws BakeError "export.normal-error" when a bound on normals is not kept and shall be
BakedOutput bake_output(const SolvedRecipe& solved, std::size_t index, const BakeOptions& options,
                        const Observer& observer);

}  // namespace morphbake
