#include "morphbake/preview/appearance.h"

#include <gtest/gtest.h>

#include "tests/unit/preview/subjects.h"

namespace morphbake {
namespace {

/// Black and white above red and blue.
Image four_texels() { return {2, 2, {0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 0, 255}}; }

void expect_near(const Eigen::Array3f& colour, float r, float g, float b) {
  EXPECT_NEAR(colour[0], r, 1e-3f);
  EXPECT_NEAR(colour[1], g, 1e-3f);
  EXPECT_NEAR(colour[2], b, 1e-3f);
}

TEST(Texture, BeginsAtTheTopLeftAndRepeats) {
  const MipLevels texture{four_texels()};
  for (const float turn : {0.0f, 1.0f, -3.0f, 1000.0f}) {
    expect_near(texture_at(texture, {turn + 0.25f, turn + 0.25f}, 0), 0, 0, 0);
    expect_near(texture_at(texture, {turn + 0.75f, turn + 0.25f}, 0), 1, 1, 1);
    expect_near(texture_at(texture, {turn + 0.25f, turn + 0.75f}, 0), 1, 0, 0);
  }
}

TEST(Texture, InterpolatesLinearLightAcrossTheSeam) {
  const MipLevels texture{four_texels()};
  expect_near(texture_at(texture, {0.5f, 0.25f}, 0), 0.5f, 0.5f, 0.5f);
  expect_near(texture_at(texture, {0.0f, 0.25f}, 0), 0.5f, 0.5f, 0.5f);
}

TEST(Texture, TakesItsMeanFromAfar) {
  AnimatedPrimitive primitive = sphere({0, 0, 0});
  primitive.texture_coordinates = Float2s::Zero(primitive.positions.rows(), 2);
  primitive.image = 0;
  AnimatedMesh mesh = still(primitive);
  mesh.images = {encode_png(four_texels())};
  const Appearance appearance = make_appearance(mesh);
  ASSERT_EQ(appearance.textures[0].size(), 2u);
  const Eigen::Array3f mean = texture_at(appearance.textures[0], {0.3f, 0.9f}, 20);
  EXPECT_NEAR(mean[0], 0.5f, 0.01f);
  EXPECT_NEAR(mean[1], 0.25f, 0.01f);
}

TEST(Appearance, MultipliesFactorVertexColourAndTexture) {
  AnimatedPrimitive primitive = sphere({0, 0, 0});
  const Eigen::Index count = primitive.positions.rows();
  primitive.base_colour = {0.5f, 1.0f, 1.0f};
  primitive.colours = Float3s::Constant(count, 3, 0.5f);
  primitive.texture_coordinates = Float2s::Constant(count, 2, 0.25f);
  primitive.texture_coordinates.col(1).setConstant(0.75f);
  primitive.image = 0;
  AnimatedMesh mesh = still(primitive);
  mesh.images = {encode_png(four_texels())};
  RayHit hit;
  hit.barycentric = {0.2f, 0.3f, 0.5f};
  expect_near(
      base_colour_at(mesh, make_appearance(mesh), mesh.primitives[0].colours, hit, 1e-6f, 1e-3f),
      0.25f, 0, 0);
}

}  // namespace
}  // namespace morphbake
