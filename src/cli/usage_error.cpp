#include "cli/commands.h"

namespace morphbake::cli {

BakeError usage_error(const std::string& message, const std::string& hint) {
  Problem problem;
  problem.code = "usage.bad-argument";
  problem.message = message;
  problem.hint = hint;
  return BakeError(problem);
}

}  // namespace morphbake::cli
