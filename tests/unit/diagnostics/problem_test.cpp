#include "morphbake/diagnostics/problem.h"

#include <gtest/gtest.h>

namespace morphbake {
namespace {

TEST(FormatProblem, NamesPlaceReasonAndRemedy) {
  const Problem problem{
      Severity::Error, "recipe.unknown-name", {"a.json", "/regions/0", 3, 7}, "no", "write yes"};
  EXPECT_EQ(format_problem(problem),
            "a.json#/regions/0:3:7: error: no [recipe.unknown-name]\n  hint: write yes");
}

/// A file or field named with an escape sequence must not colour the terminal, or worse.
TEST(FormatProblem, ShowsControlCharactersInsteadOfSendingThem) {
  const Problem problem{Severity::Warning, "a.b", {"x\x1b[31m\n", "/\x7f"}, "odd", ""};
  EXPECT_EQ(format_problem(problem), "x\\u001b[31m\\u000a#/\\u007f: warning: odd [a.b]");
}

}  // namespace
}  // namespace morphbake
