#include "morphbake/batch/connectivity_keys.h"

#include <algorithm>
#include <array>
#include <new>

#include "morphbake/json/json.h"
#include "morphbake/recipe/changes.h"
#include "morphbake/recipe/includes.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// Fields of a recipe that decide its connectivity.
constexpr std::array kDeciding = {"sources", "connectivity", "units"};

/// How often recipes that say the same are read in vain; something else is wrong with each.
constexpr int kPatience = 3;

bool may_change_connectivity(const RecipeChange& change) {
  return std::ranges::any_of(kDeciding, [&](const char* field) {
    return change.pointer.starts_with(std::string("/") + field);
  });
}

/// Whether a recipe asks for new triangles, as far as one sees without checking it.
bool asks_for_new(const Json& document) {
  if (!document.is_object()) return false;
  const auto connectivity = document.find("connectivity");
  if (connectivity == document.end() || !connectivity->is_object()) return false;
  const auto mode = connectivity->find("mode");
  return mode != connectivity->end() && (*mode == "remesh" || *mode == "resample");
}

/// All that a recipe says that decides its connectivity, and where its file names start.
std::string said_of_connectivity(const WholeRecipe& whole) {
  Json said = Json::array();
  for (const char* field : kDeciding) {
    said.push_back(whole.document.value(field, Json()));
  }
  for (const RecipePart& part : whole.parts) {
    if (!part.pointer.empty() && !part.pointer.starts_with("/sources")) continue;
    said.push_back(part.pointer);
    said.push_back(fs::absolute(part.file).parent_path().string());
  }
  return content_hash(said.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

ConnectivityKeys::ConnectivityKeys() = default;
ConnectivityKeys::~ConnectivityKeys() = default;

const WholeRecipe& ConnectivityKeys::whole(const fs::path& recipe) {
  if (!last_ || last_file_ != recipe) {
    last_ = std::make_unique<WholeRecipe>(read_with_includes(recipe));
    last_file_ = recipe;
  }
  return *last_;
}

std::string ConnectivityKeys::read_key(const BatchEntry& entry) {
  const WholeRecipe whole_recipe = changed(whole(entry.recipe), entry.changes);
  if (!asks_for_new(whole_recipe.document)) return "";
  const std::string said = said_of_connectivity(whole_recipe);
  const auto found = known_.find(said);
  if (found != known_.end()) return found->second;
  int& failures = failures_[said];
  if (failures >= kPatience) return "";
  ++failures;
  const Recipe recipe = read_recipe(entry.recipe, entry.changes);
  failures_.erase(said);
  return known_[said] = connectivity_key(recipe, files_);
}

std::string ConnectivityKeys::of(const BatchEntry& entry) {
  try {
    if (std::ranges::any_of(entry.changes, may_change_connectivity)) return read_key(entry);
    const auto found = by_file_.find(entry.recipe.native());
    if (found != by_file_.end()) return found->second;
    const std::string key = read_key(entry);
    return by_file_[entry.recipe.native()] = key;
  } catch (const BakeError&) {
  } catch (const std::bad_alloc&) {
  }
  return "";
}

}  // namespace morphbake
