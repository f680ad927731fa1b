// Calls the library from the bottom (a message) to the top: reads the recipe that it is given and
// bakes it.
#include <cstdio>
#include <string>

#include "morphbake/bake/bake.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/recipe/read_recipe.h"

namespace {

bool formats_problems() {
  morphbake::Problem problem;
  problem.code = "recipe.missing";
  problem.message = "no such file";
  problem.location.file = "none.json";
  return morphbake::format_problem(problem) == "none.json: error: no such file [recipe.missing]";
}

bool bakes(const std::string& recipe_file, const std::string& folder) {
  morphbake::Recipe recipe =
      morphbake::redirect_outputs(morphbake::read_recipe(recipe_file), folder);
  recipe.preview.reset();
  const morphbake::BakeReport report = morphbake::bake(recipe, {}, {}, {});
  std::puts(morphbake::report_to_json(report).c_str());
  return report.outputs.size() == 1 && !report.outputs[0].targets.empty();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    return formats_problems() && bakes(argv[1], argv[2]) ? 0 : 1;
  } catch (const morphbake::BakeError& error) {
    std::puts(error.what());
    return 1;
  }
}
