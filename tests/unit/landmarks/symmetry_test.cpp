#include "morphbake/landmarks/symmetry.h"

#include <gtest/gtest.h>

#include "morphbake/sources/source_surface.h"

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

}  // namespace
}  // namespace morphbake
