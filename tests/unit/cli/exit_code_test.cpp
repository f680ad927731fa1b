#include "cli/exit_code.h"

#include <gtest/gtest.h>

namespace morphbake::cli {
namespace {

Problem problem_of(Severity severity, const std::string& code) {
  Problem problem;
  problem.severity = severity;
  problem.code = code;
  return problem;
}

TEST(ExitCode, OfAnUnknownModuleIsABug) {
  EXPECT_EQ(exit_code_of("nonsense.code"), ExitCode::Bug);
  EXPECT_EQ(exit_code_of(""), ExitCode::Bug);
  EXPECT_EQ(exit_code_of("recipes.code"), ExitCode::Bug);
  EXPECT_EQ(exit_code_of("rec"), ExitCode::Bug);
}

TEST(ExitCode, OfAListOfRecipesIsThatOfRecipes) {
  EXPECT_EQ(exit_code_of("batch.bad-name"), ExitCode::Recipe);
}

TEST(ExitCode, OfWarningsAloneIsABug) {
  EXPECT_EQ(exit_code_of({problem_of(Severity::Warning, "recipe.odd")}), ExitCode::Bug);
}

TEST(ExitCode, IsThatOfTheFirstError) {
  EXPECT_EQ(exit_code_of({problem_of(Severity::Warning, "recipe.odd"),
                          problem_of(Severity::Error, "gltf.no-mesh"),
                          problem_of(Severity::Error, "recipe.unknown-name")}),
            ExitCode::SourceMesh);
}

TEST(ExitCode, OfBrokenJsonInAGltfIsTheSources) {
  Problem problem = problem_of(Severity::Error, "json.syntax");
  problem.location.file = "a.gltf";
  EXPECT_EQ(exit_code_of({problem}), ExitCode::SourceMesh);
  problem.location.file = "recipe.json";
  EXPECT_EQ(exit_code_of({problem}), ExitCode::Recipe);
}

TEST(ExitCode, FollowsTheModule) {
  for (const char* code :
       {"usage.a", "options.a", "landmarks.a", "json.a", "recipe.a", "files.a"}) {
    EXPECT_EQ(exit_code_of(code), ExitCode::Recipe) << code;
  }
  for (const char* code : {"gltf.a", "sources.a", "connectivity.a", "image.a"}) {
    EXPECT_EQ(exit_code_of(code), ExitCode::SourceMesh) << code;
  }
  for (const char* code : {"differential.a", "linear.a", "transition.a", "solve.a", "basis.a"}) {
    EXPECT_EQ(exit_code_of(code), ExitCode::Numerical) << code;
  }
  EXPECT_EQ(exit_code_of("output.a"), ExitCode::CannotWrite);
}

}  // namespace
}  // namespace morphbake::cli
