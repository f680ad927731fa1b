#pragma once

// Internal to recipe/: recipes that are written in several files.

#include <filesystem>
#include <vector>

#include "morphbake/json/json.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// A recipe with what its "include" names put in: included fields first, each list's in order.
struct WholeRecipe {
  Json document;
  std::vector<RecipePart> parts;  ///< by whom each part is written
};

/// Reads a recipe and all that it includes, and what that includes.
///
/// What a file says itself stands in place of what it includes: in "sources", "regions" and
/// "states" name by name, all other fields whole. "name" and "version" are each file's own. A file
/// that several files include counts once, where it is named first.
/// @throws BakeError as read_json; "recipe.missing-file", "recipe.cycle", "recipe.duplicate-name"
///         for what two included files say, "recipe.too-many-includes"
WholeRecipe read_with_includes(const std::filesystem::path& file);

}  // namespace morphbake
