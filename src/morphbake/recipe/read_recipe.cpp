#include "morphbake/recipe/read_recipe.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "morphbake/json/schema.h"
#include "morphbake/recipe/changes.h"
#include "morphbake/recipe/includes.h"
#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

constexpr std::size_t listed_problems = 100;

/// Whether the parts can be read in spite of `problems`: all types are right and nothing is
/// missing.
bool is_readable(const std::vector<Problem>& problems) {
  return std::all_of(problems.begin(), problems.end(), [](const Problem& problem) {
    return problem.code.ends_with(".out-of-range") || problem.code.ends_with(".unknown-field");
  });
}

/// Adds what the parts found, but not what the schema's problems explain: a field that is out of
/// range already, or one that seems missing because its name is misspelt.
void add_unexplained(std::vector<Problem>& problems, const std::vector<Problem>& found) {
  std::set<std::pair<std::string, std::string>> explained;
  for (const Problem& problem : problems) {
    const Location& at = problem.location;
    const bool misspelt = problem.code.ends_with(".unknown-field");
    explained.emplace(at.file, misspelt ? at.pointer.substr(0, at.pointer.rfind('/')) : at.pointer);
  }
  for (const Problem& problem : found) {
    if (!explained.contains({problem.location.file, problem.location.pointer})) {
      problems.push_back(problem);
    }
  }
}

void throw_problems(std::vector<Problem> problems) {
  if (problems.empty()) return;
  const std::size_t count = problems.size();
  if (count > listed_problems) {
    problems.resize(listed_problems);
    problems.push_back({Severity::Error,
                        "recipe.too-many-problems",
                        {problems.front().location.file, ""},
                        fmt::format("and {} more problems", count - listed_problems),
                        ""});
  }
  throw BakeError(std::move(problems));
}

/// Gives all shares three columns where any has them.
void harmonise_axes(Recipe& recipe) {
  std::vector<Shares*> all = {&recipe.timeline.start};
  for (Track& track : recipe.timeline.tracks) all.push_back(&track.edit.to);
  for (State& state : recipe.states) {
    all.push_back(&state.mix);
    for (Edit& edit : state.edits) all.push_back(&edit.to);
  }
  const bool any =
      std::any_of(all.begin(), all.end(), [](const Shares* s) { return s->cols() > 1; });
  if (!any) return;
  for (Shares* shares : all) {
    if (shares->cols() == 1) *shares = shares->replicate(1, 3).eval();
  }
}

void read_parts(Reading& reading) {
  const Json& document = reading.document;
  reading.recipe.name = document["name"].get<std::string>();
  check_name_length(reading, reading.recipe.name, "/name");
  if (document.value("units", "") == "scene") reading.recipe.units = Units::Scene;
  reading.recipe.options = document.value("options", Json::object()).dump();
  read_sources(reading);
  read_connectivity(reading);
  read_regions(reading);
  read_derived(reading);
  read_states(reading);
  read_timeline(reading);
  harmonise_axes(reading.recipe);
  read_constraints(reading);
  read_outputs(reading);
  read_preview(reading);
}

}  // namespace

Recipe read_recipe(const std::filesystem::path& file, const std::vector<RecipeChange>& changes) {
  const auto [document, parts] = changed(read_with_includes(file), changes);
  std::vector<Problem> problems =
      schema_problems(document, shipped_schema("recipe.schema.json"), {file.string(), ""});
  for (Problem& problem : problems) {
    const RecipePart& part = part_at(parts, problem.location.pointer);
    problem.location = {part.file.string(), problem.location.pointer, part.line, part.column};
  }
  if (!is_readable(problems)) throw_problems(problems);
  Reading reading{document, std::filesystem::absolute(file).parent_path(), {}, {}, {}};
  reading.recipe.file = file;
  reading.recipe.parts = parts;
  reading.recipe.document = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  read_parts(reading);
  add_unexplained(problems, reading.problems);
  throw_problems(std::move(problems));
  return std::move(reading.recipe);
}

Recipe redirect_outputs(Recipe recipe, const std::filesystem::path& folder) {
  for (Output& output : recipe.outputs) {
    output.file = std::filesystem::absolute(folder / output.file.filename()).lexically_normal();
  }
  std::vector<Problem> problems;
  check_output_files(recipe, problems);
  throw_problems(std::move(problems));
  return recipe;
}

}  // namespace morphbake
