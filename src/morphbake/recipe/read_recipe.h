#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// A value that is put into a recipe in place of what it says.
struct RecipeChange {
  std::string pointer;  ///< JSON pointer of the whole recipe, with what it includes
  std::string value;    ///< JSON text
  Location at;          ///< who asks for it: a file, line and column; file names start there
};

/// Reads a recipe and the landmark files that it names; all names resolved, all defaults filled in.
///
/// @throws BakeError with all problems found: "json.syntax", "json.duplicate-key",
/// "recipe.unknown-field",
///         "recipe.wrong-type", "recipe.out-of-range", "recipe.missing-field",
///         "recipe.unknown-name", "recipe.bad-pointer", ...
/// @param changes  in their order, made once all that the recipe includes is read
Recipe read_recipe(const std::filesystem::path& file,
                   const std::vector<RecipeChange>& changes = {});

/// A copy of `recipe` that writes into `folder`, each output under its own file name.
Recipe redirect_outputs(Recipe recipe, const std::filesystem::path& folder);

/// What a first recipe says beside its sources; nothing for sources that share their triangles.
struct FirstChoices {
  bool remesh = false;          ///< whether they get new triangles
  std::vector<bool> is_unlike;  ///< one a source, or none: whether it is aligned to the first
  std::vector<NameOrIndex> nodes = {};  ///< one a source, or none: whose mesh of the file is meant
};

/// A first recipe over `sources` that bakes, as JSON text.
///
/// @param sources  two or more glTF files; their landmark files are found beside them
/// @param schema   recipe.schema.json for "$schema", by which editors complete; empty for none
std::string first_recipe(const std::vector<std::filesystem::path>& sources,
                         const std::filesystem::path& recipe_file,
                         const std::filesystem::path& schema, const FirstChoices& choices = {});

}  // namespace morphbake
