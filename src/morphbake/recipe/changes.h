#pragma once

// Internal to recipe/ and batch/: recipes of which a list or a table says something else.

#include <vector>

#include "morphbake/recipe/includes.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake {

/// A recipe with `changes` made, each of which becomes a part. What is not there yet is made, as
/// far as objects go; whether it may be there is the schema's to say.
///
/// @throws BakeError "recipe.bad-pointer" with all pointers that name nothing, "json.syntax"
WholeRecipe changed(WholeRecipe whole, const std::vector<RecipeChange>& changes);

}  // namespace morphbake
