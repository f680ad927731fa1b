#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake {

/// One recipe of a batch.
struct BatchEntry {
  std::string name;  ///< of its folder below that of all outputs: "nose/recipe"
  std::filesystem::path recipe;
  std::vector<RecipeChange> changes;
  Location at;  ///< who names it; the file may be "" for a recipe that is named directly
};

/// What a batch bakes, in order.
///
/// Only names are kept; everything else of an entry is read from its file again, so that a list of
/// a million recipes takes little memory.
struct Manifest {
  std::vector<std::string> names;               ///< all different
  std::function<BatchEntry(std::size_t)> read;  ///< an entry but for its name
};

/// An entry, read from its file.
BatchEntry entry_of(const Manifest& manifest, std::size_t index);

/// Reads a list of recipes.
///
/// @param named  a list (.jsonl: a recipe's file name, or {"recipe", "name", "set"}, a line), a
/// recipe
///               (.json), or a pattern of recipes, as files_matching has it
/// @param table  with a recipe: a row is the recipe with changes (.csv or .jsonl), whose columns
/// are
///               JSON pointers and "name"; "" for none
/// @throws BakeError with all problems found, up to 100: "batch.empty", "batch.bad-name",
///         "batch.duplicate-name", "batch.wrong-type", "batch.unknown-field",
///         "batch.missing-field", "batch.bad-table", "batch.line-too-long", "json.syntax",
///         "files.missing", ...
Manifest read_manifest(const std::filesystem::path& named, const std::filesystem::path& table);

}  // namespace morphbake
