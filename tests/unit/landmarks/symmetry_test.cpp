#include "morphbake/landmarks/symmetry.h"

#include <gtest/gtest.h>

#include "morphbake/sources/source_surface.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

ShapeSketch sketch_of(const std::string& name) {
  const SourceRef ref{name, MORPHBAKE_SOURCE_DIR "/examples/shapes/" + name + ".glb", {}, {}};
  return sketch_shape(source_surface(load_source(ref), ref, {}).mesh);
}

TEST(RespectSymmetry, TipsOnThePlaneTakeNoPartnerOffIt) {
  Symmetry a, b;
  a.found = b.found = true;
  a.mirrored = {0, 2, 1};
  b.mirrored = {1, 0, 2};
  std::vector<int> partner = {0, 2, -1};
  respect_symmetry(a, b, partner);
  EXPECT_EQ(partner, (std::vector<int>{-1, -1, -1}));
}

TEST(RespectSymmetry, TheOneAcrossGetsThePartnerAcross) {
  Symmetry a, b;
  a.found = b.found = true;
  a.mirrored = {1, 0};
  b.mirrored = {1, 0, 2};
  std::vector<int> partner = {1, 2};
  respect_symmetry(a, b, partner);
  EXPECT_EQ(partner, (std::vector<int>{1, 0}));
}

TEST(FindSymmetry, PairsTheTipsOfACow) {
  const ShapeSketch cow = sketch_of("cow");
  const Symmetry symmetry = find_symmetry(cow);
  EXPECT_TRUE(symmetry.is_exact);
  EXPECT_GT(symmetry.sideways.x(), 0.99);
  ASSERT_EQ(symmetry.mirrored.size(), 10U);
  int pairs = 0;
  for (std::size_t i = 0; i < symmetry.mirrored.size(); ++i) {
    ASSERT_GE(symmetry.mirrored[i], 0);
    const auto across = static_cast<std::size_t>(symmetry.mirrored[i]);
    pairs += across > i;
    const auto position = [&](std::size_t tip) -> Eigen::Vector3d {
      return cow.mesh.positions.row(cow.tips[tip].vertex);
    };
    EXPECT_LT((symmetry.across(position(i)) - position(across)).norm(), 0.1);
  }
  EXPECT_EQ(pairs, 4);  // ears, horns, front and hind feet
}

TEST(FindSymmetry, ACrookedPoseHasPairsStill) {
  const Symmetry symmetry = find_symmetry(sketch_of("bar_bent_twisted"));
  EXPECT_FALSE(symmetry.is_exact);
}

TEST(DropBranches, OfAHandOneFingerStays) {
  ShapeSketch shape;
  shape.mesh = test::sphere(12, 16);
  const Eigen::Index count = shape.mesh.positions.rows();
  shape.tips = {{.vertex = 0, .prominence = 1},
                {.vertex = 40, .prominence = 0.1},
                {.vertex = 75, .prominence = 0.1},
                {.vertex = 41, .prominence = 0.05}};
  shape.from_tip.assign(4, Eigen::VectorXd::Constant(count, 0.6));
  shape.from_tip[0](40) = 0.2;  // a finger, small and near; the others are too far or no smaller
  shape.from_tip[1](41) = 0.2;
  drop_branches(shape);
  ASSERT_EQ(shape.tips.size(), 3U);
  ASSERT_EQ(shape.from_tip.size(), 3U);
  EXPECT_EQ(shape.tips[1].vertex, 75);
  EXPECT_EQ(shape.tips[2].vertex, 41);
}

}  // namespace
}  // namespace morphbake
