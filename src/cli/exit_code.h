#pragma once

#include <string_view>
#include <vector>

#include "morphbake/diagnostics/problem.h"

namespace morphbake::cli {

/// What the program returns; the numbers are part of its interface (`morphbake --help` lists them).
enum class ExitCode {
  Done = 0,
  Bug = 1,
  Recipe = 2,      ///< or usage
  SomeFailed = 3,  ///< of the recipes of a batch
  SourceMesh = 4,
  Numerical = 5,
  CannotWrite = 6,
  Interrupted = 130,

  // Of commands that judge: `diff`, `golden`, `lint`. Whatever keeps them from judging is Unjudged.
  Same = 0,
  Different = 1,
  Unjudged = 2,
};

/// The exit code that belongs to a problem's code, by its module: "gltf.no-mesh" -> SourceMesh.
///
/// @return  Bug for a module that is not known
ExitCode exit_code_of(std::string_view problem_code);

/// The exit code of the first error among `problems`; warnings do not count. Broken JSON inside a
/// glTF file is the source's fault, not the recipe's.
ExitCode exit_code_of(const std::vector<Problem>& problems);

}  // namespace morphbake::cli
