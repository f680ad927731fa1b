#pragma once

#include <string>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {

/// A mistake of the program itself, "bug.unexpected", which only its main loops tell.
inline Problem bug(const std::string& what) {
  Problem problem;
  problem.code = "bug.unexpected";
  problem.message = what;
  problem.hint = "this is a bug of morphbake: please report it with the recipe and its sources";
  return problem;
}

}  // namespace morphbake
