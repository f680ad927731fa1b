#include "morphbake/landmarks/suggest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/recipe/read_landmarks.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

SourceSurface surface_of(const Mesh& mesh, const std::string& name) {
  SourceSurface surface;
  surface.name = name;
  surface.file = name + ".glb";
  surface.mesh = mesh;
  return surface;
}

std::string shape_file(const std::string& name, const char* extension) {
  return MORPHBAKE_SOURCE_DIR "/examples/shapes/" + name + extension;
}

SourceSurface example(const std::string& name) {
  const SourceRef ref{name, shape_file(name, ".glb"), {}, {}};
  return source_surface(load_source(ref), ref, {});
}

/// Positions that the example's landmark file names.
std::map<std::string, Eigen::Vector3d> named_points(const std::string& name) {
  std::map<std::string, Eigen::Vector3d> points;
  for (const Landmark& each : read_landmarks(shape_file(name, ".landmarks.json"), name)) {
    points[each.name] = std::get<Eigen::Vector3d>(each.at);
  }
  return points;
}

/// Suggestions and the codes of the warnings.
struct Told {
  SuggestedLandmarks landmarks;
  std::vector<std::string> codes;
};

Told suggested(const SourceSurface& a, const SourceSurface& b, int count = 10) {
  Told told;
  Observer observer;
  observer.on_problem = [&](const Problem& problem) { told.codes.push_back(problem.code); };
  told.landmarks = suggest_landmarks(a, b, {count}, observer);
  return told;
}

/// Row of the suggestion within 5 % of the diagonal of a point, or -1.
int near(const Positions& rows, const Eigen::Vector3d& point, double diagonal) {
  Eigen::Index closest = 0;
  const double distance = (rows.rowwise() - point.transpose()).rowwise().norm().minCoeff(&closest);
  return distance < 0.05 * diagonal ? static_cast<int>(closest) : -1;
}

/// A ball with a long arm towards +X, a shorter one up, and a stub to the front: its mirror images
/// are other shapes.
Mesh crooked_shape() {
  Mesh mesh = test::sphere(40, 60);
  const auto arm = [&](const Eigen::Vector3d& towards, double length) {
    for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
      const double cosine = mesh.positions.row(v).normalized().dot(towards.normalized());
      const double inside = std::max(0.0, (cosine - 0.9) / 0.1);
      mesh.positions.row(v) *= 1 + length * inside * inside;
    }
  };
  arm({1, 0.3, 0}, 3);
  arm({-0.2, 1, 0.1}, 2);
  arm({0.1, -0.2, 1}, 1.2);
  arm({-1, -0.6, -0.5}, 0.8);
  return mesh;
}

TEST(SuggestLandmarks, TooFewVerticesAreAProblem) {
  Mesh triangle{Positions(3, 3), Triangles(1, 3)};
  triangle.positions << 0, 0, 0, 1e-3, 0, 0, 0, 1e-3, 0;
  triangle.triangles << 0, 1, 2;
  const SourceSurface surface = surface_of(triangle, "a");
  try {
    EXPECT_LE(suggest_landmarks(surface, surface, {10}, {}).names.size(), 3U);
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems()[0].code, "landmarks.nothing-found");
  }
}

TEST(SuggestLandmarks, CanBeStopped) {
  Observer observer;
  observer.is_cancelled = [] { return true; };
  const SourceSurface ball = surface_of(test::sphere(12, 16), "a");
  EXPECT_THROW(suggest_landmarks(ball, ball, {}, observer), Cancelled);
}

TEST(SuggestLandmarks, OfBallsAreSpreadPointsAndAWarning) {
  const SourceSurface ball = surface_of(test::sphere(24, 32), "a");
  const Told told = suggested(ball, ball);
  EXPECT_THAT(told.codes, ElementsAre("landmarks.uncertain"));
  EXPECT_GE(told.landmarks.names.size(), 6U);
  EXPECT_LT(largest_distance(told.landmarks.a, told.landmarks.b), 1e-12);
}

TEST(SuggestLandmarks, TakeTheLargestPieceAndSaySo) {
  Mesh far_ball = test::sphere(8, 10);
  far_ball.positions *= 0.2;
  far_ball.positions.col(0).array() += 5;
  const SourceSurface two = surface_of(test::joined(far_ball, crooked_shape()), "two");
  const Told told = suggested(two, surface_of(crooked_shape(), "one"));
  EXPECT_THAT(told.codes, ElementsAre("landmarks.several-pieces"));
  EXPECT_LT(largest_distance(told.landmarks.a, told.landmarks.b), 1e-9);
}

TEST(SuggestLandmarks, AMirroredCopyIsRecognised) {
  const SourceSurface shape = surface_of(crooked_shape(), "a");
  SourceSurface mirrored = shape;
  mirrored.mesh.positions.col(0) *= -1;
  mirrored.mesh.triangles.col(1).swap(mirrored.mesh.triangles.col(2));
  EXPECT_THAT(suggested(shape, mirrored).codes, testing::Contains("landmarks.mirrored"));
  EXPECT_THAT(suggested(shape, shape).codes, IsEmpty());
}

TEST(SuggestLandmarks, OfShapesWhoseTipsLieDifferentlyAreUncertain) {
  EXPECT_THAT(suggested(example("horse"), example("bird")).codes,
              ElementsAre("landmarks.uncertain"));
  EXPECT_THAT(suggested(example("horse"), example("giraffe")).codes, IsEmpty());
}

TEST(SuggestLandmarks, AnOpenShapeBesideAClosedOneIsToldOf) {
  EXPECT_THAT(suggested(example("face"), example("pig")).codes,
              testing::Contains("correspondence.different-topology"));
}

TEST(SuggestLandmarks, FollowATurnedAndScaledCopy) {
  const SourceSurface shape = surface_of(crooked_shape(), "a");
  SourceSurface turned = shape;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.2, Eigen::Vector3d(0.1, 1, 0.2).normalized()).toRotationMatrix();
  turned.mesh.positions =
      (0.3 * shape.mesh.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(5, -2, 1);
  const Told told = suggested(shape, turned);
  EXPECT_THAT(told.codes, IsEmpty());
  const Positions expected =
      (0.3 * told.landmarks.a * turn.transpose()).rowwise() + Eigen::RowVector3d(5, -2, 1);
  for (std::size_t i = 0; i < told.landmarks.names.size(); ++i) {
    if (!told.landmarks.names[i].starts_with("tip")) continue;
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_LT((told.landmarks.b.row(row) - expected.row(row)).norm(), 0.05) << i;
  }
}

TEST(SuggestLandmarks, FindTheTipsOfAnimals) {
  const SourceSurface cow = example("cow"), giraffe = example("giraffe");
  const Told told = suggested(cow, giraffe);
  EXPECT_THAT(told.codes, IsEmpty());
  EXPECT_EQ(told.landmarks.names.size(), 10U);
  const auto on_cow = named_points("cow"), on_giraffe = named_points("giraffe");
  for (const char* name :
       {"nose", "tail_tip", "ear_left", "ear_right", "horn_left", "horn_right", "front_foot_left",
        "front_foot_right", "hind_foot_left", "hind_foot_right"}) {
    const int row = near(told.landmarks.a, on_cow.at(name), bounding_diagonal(cow.mesh.positions));
    ASSERT_GE(row, 0) << name;
    EXPECT_EQ(
        row, near(told.landmarks.b, on_giraffe.at(name), bounding_diagonal(giraffe.mesh.positions)))
        << name;
    const std::string& suggested_name = told.landmarks.names[static_cast<std::size_t>(row)];
    for (const char* side : {"_left", "_right"}) {
      EXPECT_EQ(std::string(name).ends_with(side), suggested_name.ends_with(side))
          << name << " is called " << suggested_name;
    }
  }
}

TEST(SuggestLandmarks, LieOnTheSurface) {
  const SourceSurface cow = example("cow"), bird = example("bird");
  const Told told = suggested(cow, bird, 20);
  const std::vector<SurfacePoint> closest = closest_points(cow.mesh, told.landmarks.a);
  for (std::size_t i = 0; i < closest.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_LT((position_of(cow.mesh, closest[i]) - told.landmarks.a.row(row).transpose()).norm(),
              1e-12);
  }
  EXPECT_LE(told.landmarks.names.size(), 20U);
}

TEST(SuggestLandmarks, OfOpenSurfacesAreOnTheRimToo) {
  const Told told = suggested(example("face"), example("face_long_nose"));
  const auto on_face = named_points("face"), on_other = named_points("face_long_nose");
  const int row = near(told.landmarks.a, on_face.at("nose_tip"), 0.35);
  ASSERT_GE(row, 0);
  EXPECT_EQ(row, near(told.landmarks.b, on_other.at("nose_tip"), 0.35));
  EXPECT_THAT(told.landmarks.names,
              testing::IsSupersetOf({"rim_1", "rim_2", "rim_3_left", "rim_3_right"}));
}

TEST(SuggestLandmarks, AreTheSameEachTime) {
  const SourceSurface pig = example("pig"), horse = example("horse");
  const SuggestedLandmarks one = suggested(pig, horse).landmarks;
  const SuggestedLandmarks two = suggested(pig, horse).landmarks;
  EXPECT_EQ(one.names, two.names);
  EXPECT_EQ(one.a, two.a);
  EXPECT_EQ(one.b, two.b);
}

}  // namespace
}  // namespace morphbake
