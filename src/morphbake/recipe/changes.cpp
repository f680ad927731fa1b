#include "morphbake/recipe/changes.h"

#include <fmt/core.h>

#include <charconv>
#include <optional>
#include <string>
#include <utility>

namespace morphbake {
namespace {

/// What keeps a value from being put in.
struct Refusal {
  std::string message;
  std::string hint;
};

/// The fields that lead to a value; none where the text is no JSON pointer.
std::optional<std::vector<std::string>> steps_of(const std::string& pointer) {
  if (pointer.size() < 2 || pointer.front() != '/') return {};
  std::vector<std::string> steps;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      steps.emplace_back();
    } else if (pointer[i] != '~') {
      steps.back() += pointer[i];
    } else if (i + 1 < pointer.size() && (pointer[i + 1] == '0' || pointer[i + 1] == '1')) {
      steps.back() += pointer[++i] == '0' ? '~' : '/';
    } else {
      return {};
    }
  }
  return steps;
}

std::optional<std::size_t> index_of(const std::string& step) {
  std::size_t index = 0;
  const char* end = step.data() + step.size();
  const auto [read, error] = std::from_chars(step.data(), end, index);
  if (error != std::errc() || read != end || step.empty()) return {};
  return index;
}

/// What `step` names in `owner`, made if it is a field that is not there; null after a refusal.
Json* child_of(Json& owner, const std::string& step, const std::string& at, Refusal& refusal) {
  if (owner.is_null()) owner = Json::object();
  if (owner.is_object()) return &owner[step];
  const std::string name = at.empty() ? "the recipe" : at;
  if (!owner.is_array()) {
    refusal = {fmt::format("{} is {}: nothing stands in it", name, shown(owner)),
               fmt::format("set {} itself to an object", name)};
    return nullptr;
  }
  const std::optional<std::size_t> index = index_of(step);
  if (index && *index < owner.size()) return &owner[*index];
  refusal = {fmt::format("{} has no entry {}; it has {}", name, shown(Json(step)), owner.size()),
             "entries are counted from 0"};
  return nullptr;
}

/// Puts a value in; says why not where it cannot.
///
/// @param made  receives the pointer of the outermost thing that was not there before
std::optional<Refusal> put_in(Json& document, const RecipeChange& change, std::string& made) {
  const std::optional<std::vector<std::string>> steps = steps_of(change.pointer);
  if (!steps) {
    return Refusal{fmt::format("{} is no JSON pointer", shown(Json(change.pointer))),
                   "write for example \"/timeline/duration\"; ~1 stands for / and ~0 for ~"};
  }
  if (steps->front() == "include") {
    return Refusal{"what a recipe includes is read before it is changed",
                   "change the fields themselves"};
  }
  if (!document.is_object()) return {};  // the schema tells
  Json* at = &document;
  std::string pointer;
  Refusal refusal;
  for (const std::string& step : *steps) {
    if (made.empty() && at->is_object() && !at->contains(step)) made = child_pointer(pointer, step);
    at = child_of(*at, step, pointer, refusal);
    if (at == nullptr) return refusal;
    pointer = child_pointer(pointer, step);
  }
  *at = parse_json(change.value, change.at.file);
  return {};
}

}  // namespace

WholeRecipe changed(WholeRecipe whole, const std::vector<RecipeChange>& changes) {
  std::vector<Problem> problems;
  for (const RecipeChange& change : changes) {
    std::string made;
    if (const std::optional<Refusal> refusal = put_in(whole.document, change, made)) {
      Location at = change.at;
      at.pointer = change.pointer;
      problems.push_back(
          {Severity::Error, "recipe.bad-pointer", at, refusal->message, refusal->hint});
      continue;
    }
    const std::string& pointer = made.empty() ? change.pointer : made;
    whole.parts.push_back({pointer, change.at.file, change.at.line, change.at.column});
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return whole;
}

}  // namespace morphbake
