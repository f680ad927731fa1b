#include "morphbake/preview/landmark_sheet.h"

#include <gtest/gtest.h>

#include "morphbake/preview/still_view.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

AnimatedMesh ball() {
  const Mesh mesh = test::sphere(24, 32);
  AnimatedMesh animated;
  AnimatedPrimitive& primitive = animated.primitives.emplace_back();
  primitive.triangles = mesh.triangles;
  primitive.positions = mesh.positions.cast<float>();
  animated.weights.values.resize(1, 0);
  animated.to_scene(0, 3) = 10;  // the scene is not the mesh's space
  return animated;
}

TEST(RenderStill, SeesTheNearSideAndHidesTheFarOne) {
  Positions points(4, 3);
  points << 10, 0, 1, 10, 0, -1, 11, 0, 0, 10, 1, 0;
  TurntableOptions look;
  look.width = look.height = 64;
  look.samples = 1;
  look.azimuth = 0;
  look.elevation = 0;
  const StillView front = render_still(ball(), look, points);
  ASSERT_EQ(front.points.size(), 4U);
  EXPECT_FALSE(front.points[0].is_hidden);
  EXPECT_TRUE(front.points[1].is_hidden);
  EXPECT_LT((front.points[0].pixel - Eigen::Vector2f(32, 32)).norm(), 1);
  EXPECT_GT(front.points[2].pixel.x(), 45);  // +X is on the right, +Y above
  EXPECT_LT(front.points[3].pixel.y(), 19);
  look.azimuth = 180;
  const StillView back = render_still(ball(), look, points);
  EXPECT_TRUE(back.points[0].is_hidden);
  EXPECT_FALSE(back.points[1].is_hidden);
  EXPECT_LT(back.points[2].pixel.x(), 19);
}

TEST(RenderLandmarkSheet, TakesNoLandmarksManyAndAwkwardNames) {
  LandmarkSheetOptions options;
  options.view_size = 64;
  options.samples = 1;
  const Image none = render_landmark_sheet({{"", ball(), Positions(0, 3)}}, {}, options, {});
  EXPECT_EQ(none.rgb.size(), static_cast<std::size_t>(3 * none.width * none.height));
  Positions points(40, 3);
  std::vector<std::string> names;
  for (int i = 0; i < 40; ++i) {
    points.row(i) << 10 + std::sin(i), 0, std::cos(i);
    names.push_back("landmark größe 長 " + std::to_string(i));
  }
  const std::string title(200, 'x');
  const Image many = render_landmark_sheet({{title, ball(), points}}, names, options, {});
  EXPECT_GT(many.height, 40 * 20);
}

TEST(RenderLandmarkSheet, ThreadsChangeNoPixel) {
  LandmarkSheetOptions options;
  options.view_size = 64;
  options.samples = 2;
  Positions points(1, 3);
  points << 10, 0, 1;
  const std::vector<MarkedShape> shapes = {{"ball", ball(), points}};
  options.threads = 1;
  const Image one = render_landmark_sheet(shapes, {"nose"}, options, {});
  options.threads = 2;
  EXPECT_EQ(one.rgb, render_landmark_sheet(shapes, {"nose"}, options, {}).rgb);
}

}  // namespace
}  // namespace morphbake
