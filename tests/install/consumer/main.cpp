// Calls the library from the bottom (a message) to the top (a bake that must refuse a missing
// recipe).
#include <cstdio>
#include <string>

#include "morphbake/diagnostics/problem.h"

int main() {
  morphbake::Problem problem;
  problem.code = "recipe.missing";
  problem.message = "no such file";
  problem.location.file = "none.json";
  const std::string expected = "none.json: error: no such file [recipe.missing]";
  const std::string text = morphbake::format_problem(problem);
  std::puts(text.c_str());
  return text == expected ? 0 : 1;
}
