#include "morphbake/bake/mismatch_picture.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using test::source_of;

Image picture_of(const SourceMesh& first, const SourceMesh& other) {
  BakeOptions options;
  options.turntable.samples = 1;
  return mismatch_picture(first, other, find_mismatch(first, other), options, {});
}

/// Clearly red pixels in a part of a picture: columns from `left` to `right`, as shares.
int reds(const Image& image, double left, double right) {
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = static_cast<int>(left * image.width); x < right * image.width; ++x) {
      const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x));
      const int r = image.rgb[at], g = image.rgb[at + 1], b = image.rgb[at + 2];
      count += r > 90 && r > 2 * g && r > 2 * b;
    }
  }
  return count;
}

Mesh holed_sphere() {
  Mesh mesh = test::sphere(16, 24);
  mesh.triangles = Triangles(mesh.triangles.topRows(mesh.triangles.rows() - 2));
  return mesh;
}

TEST(MismatchPicture, OfSourcesWithoutTrianglesOrSizeIsDrawn) {
  const SourceMesh sphere = source_of(test::sphere(16, 24), "a");
  EXPECT_GT(picture_of(sphere, source_of({Positions::Zero(1, 3), Triangles(0, 3)}, "b")).width, 0);
  const SourceMesh point = source_of({Positions::Zero(3, 3), Eigen::RowVector3i(0, 1, 2)}, "b");
  EXPECT_GT(picture_of(sphere, point).width, 0);
  EXPECT_GT(picture_of(point, sphere).width, 0);
}

TEST(MismatchPicture, OfHugeNumbersIsDrawn) {
  Mesh huge = test::sphere(16, 24), huge_holed = holed_sphere();
  huge.positions *= 1e50;
  huge_holed.positions *= 1e50;
  EXPECT_GT(reds(picture_of(source_of(huge, "a"), source_of(huge_holed, "b")), 0, 1), 100);
}

TEST(MismatchPicture, ShowsWhatDiffersInRedFromAnySide) {
  const Mesh whole = test::sphere(16, 24), holed = holed_sphere();  // below
  const Eigen::Matrix3d upside_down = Eigen::Vector3d(1, -1, -1).asDiagonal();
  for (const Eigen::Matrix3d& turn : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), upside_down}) {
    Mesh a = whole, b = holed;
    a.positions *= turn;
    b.positions *= turn;
    const Image picture = picture_of(source_of(a, "a"), source_of(b, "b"));
    EXPECT_GT(picture.height, picture.width / 2);  // with a close look
    EXPECT_GT(reds(picture, 0, 0.5), 200);
    EXPECT_GT(reds(picture, 0.5, 1), 200);
  }
}

TEST(MismatchPicture, HasNoRedWhereASourceLacksAPiece) {
  const Mesh sphere = test::sphere(16, 24);
  Mesh piece = test::tetrahedron();
  piece.positions.rowwise() += Eigen::RowVector3d(1, 1, 0);
  const Image picture =
      picture_of(source_of(sphere, "a"), source_of(test::joined(sphere, piece), "b"));
  EXPECT_EQ(reds(picture, 0, 0.5), 0);
  EXPECT_GT(reds(picture, 0.5, 1), 200);
}

}  // namespace
}  // namespace morphbake
