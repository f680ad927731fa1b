#pragma once

#include <string>
#include <vector>

#include "morphbake/basis/basis_options.h"
#include "morphbake/preview/turntable.h"
#include "morphbake/solve/solve_options.h"

namespace morphbake {

/// Options of every stage, grouped by the stage's name: the same tree as config/bake.json.
struct BakeOptions {
  SolveOptions solve;
  BasisOptions basis;
  TurntableOptions turntable;
  int threads = 0;  ///< 0: all cores; never changes a byte, so it is no field of a file
};

/// The options as JSON text with their defaults: what `morphbake config` prints.
std::string options_to_json(const BakeOptions& options);

/// Built-in defaults < the recipe's "options" < `settings`.
///
/// @param recipe_options  JSON text of the recipe's "options" object
/// @param recipe_file     for messages
/// @param settings        "/basis/easing_tolerance=1e-7" each, from --set
/// @throws BakeError "options.unknown-field", "options.wrong-type", "options.out-of-range",
/// "options.bad-setting"
BakeOptions read_options(const std::string& recipe_options, const std::string& recipe_file,
                         const std::vector<std::string>& settings);

}  // namespace morphbake
