#pragma once

#include <optional>
#include <string>
#include <vector>

#include "morphbake/bake/bake_cache.h"
#include "morphbake/bake/options.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

enum class PlannedState {
  Cached,  ///< taken from the cache
  Runs,
  Unneeded,  ///< what comes of it is in the cache
};

/// A stage of a bake that did not run yet.
struct PlannedStage {
  std::string name;
  PlannedState state = PlannedState::Runs;
  std::optional<double> seconds;  ///< that it took when it ran last
  std::string reason;             ///< why it is to run: what changed; "" where it does not
};

/// What a bake would do, without loading a mesh.
///
/// @param cache  of this recipe
/// @throws BakeError as bake_keys
std::vector<PlannedStage> plan(const Recipe& recipe, const BakeOptions& options,
                               const BakeCache& cache);

/// Keeps what a bake's stages were, so that the next plan can say what changed.
void remember_plan(const Recipe& recipe, const BakeKeys& keys, BakeCache& cache);

/// A plan as JSON text.
std::string plan_to_json(const std::vector<PlannedStage>& stages);

}  // namespace morphbake
