#include "morphbake/bake/choose_representation.h"

#include <gtest/gtest.h>

#include "morphbake/diagnostics/problem.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

const Observer nobody;

Recipe recipe_of(Representation representation) {
  Recipe recipe;
  recipe.representation = representation;
  recipe.timeline.start = Eigen::Vector2d(1, 0);
  recipe.timeline.tracks.emplace_back().edit.to = Eigen::Vector2d(0, 1);
  return recipe;
}

TEST(ChooseRepresentation, MeasuresHowFarShapesAreTurned) {
  const Mesh bar = test::bar(8);
  const MorphableMesh turned =
      test::morphable(bar.triangles, {bar.positions, test::bent_and_twisted(bar.positions, 0, 2)});
  EXPECT_EQ(choose_representation(recipe_of(Representation::Auto), turned, nobody).representation,
            Representation::Rotation);
  const MorphableMesh still = test::morphable(bar.triangles, {bar.positions, 2 * bar.positions});
  const RepresentationChoice choice =
      choose_representation(recipe_of(Representation::Auto), still, nobody);
  EXPECT_EQ(choice.representation, Representation::Laplacian);
  EXPECT_FALSE(choice.deformations);
}

TEST(ChooseRepresentation, TurnsNothingAgainstAPoint) {
  const Mesh bar = test::bar(8);
  const MorphableMesh mesh = test::morphable(
      bar.triangles, {Positions(Positions::Ones(bar.positions.rows(), 3)), bar.positions});
  try {
    choose_representation(recipe_of(Representation::Rotation), mesh, nobody);
    FAIL() << "a point was taken";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems().front().code, "solve.no-extent");
  }
  EXPECT_EQ(choose_representation(recipe_of(Representation::Auto), mesh, nobody).representation,
            Representation::Laplacian);
}

}  // namespace
}  // namespace morphbake
