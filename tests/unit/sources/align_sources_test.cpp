#include "morphbake/sources/align_sources.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "shapes/shapes.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

const std::vector<int> kMarked{1, 17, 40, 66};  // vertices of the sphere, not in one plane

Affine3d similarity() {
  Affine3d map = Affine3d::Identity();
  map.translate(Vector3d(100, -30, 7));
  map.rotate(Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized()));
  map.scale(40);
  return map;
}

/// A bent sphere and the same moved by `map`, both with landmarks at the same vertices.
struct Pair {
  explicit Pair(const Affine3d& map, Align align) {
    Mesh mesh = test::sphere(10, 12);
    mesh.positions = test::bent(mesh.positions, 0.2, 3);
    Mesh moved = mesh;
    for (auto row : moved.positions.rowwise()) row = (map * row.transpose()).transpose().eval();
    sources = {test::source_of(mesh, "a"), test::source_of(moved, "b")};
    recipe.sources = {{"a", "a.glb", {}, {}}, {"b", "b.glb", {}, {}, align}};
    for (const int v : kMarked) {
      const std::string name = "mark " + std::to_string(v);
      recipe.sources[0].landmarks.push_back({name, VertexPlace{v}});
      recipe.sources[1].landmarks.push_back({name, Vector3d(moved.positions.row(v))});
    }
  }

  AlignedSources aligned(std::vector<std::string>* warnings = nullptr) const {
    Observer observer;
    observer.on_problem = [&](const Problem& problem) {
      if (warnings) warnings->push_back(problem.code);
    };
    return align_sources(recipe, sources, observer);
  }

  Recipe recipe;
  std::vector<SourceMesh> sources;
};

double apart(const AlignedSources& aligned) {
  return (aligned.sources[0].positions - aligned.sources[1].positions).cwiseAbs().maxCoeff();
}

std::string code_of(const Pair& pair) {
  try {
    pair.aligned();
  } catch (const BakeError& error) {
    return error.problems().front().code;
  }
  return "";
}

TEST(AlignSources, UndoesASimilarityByLandmarksAndTakesPlacesAlong) {
  Pair pair(similarity(), Align::Similarity);
  const Vector3d before = std::get<Vector3d>(pair.recipe.sources[1].landmarks[2].at);
  pair.recipe.regions.push_back({"part", BallRegion{1, before, 0.1, 0.2}});
  pair.recipe.gauge.kind = Gauge::Kind::Landmark;
  pair.recipe.gauge.source = 1;
  pair.recipe.gauge.at = before;
  const AlignedSources aligned = pair.aligned();
  EXPECT_LT(apart(aligned), 1e-12);
  const Vector3d there = pair.sources[0].positions.row(kMarked[2]);
  EXPECT_LT((std::get<Vector3d>(aligned.recipe.sources[1].landmarks[2].at) - there).norm(), 1e-12);
  const auto& ball = std::get<BallRegion>(aligned.recipe.regions[0].shape);
  EXPECT_LT((std::get<Vector3d>(ball.centre) - there).norm(), 1e-12);
  EXPECT_LT((std::get<Vector3d>(aligned.recipe.gauge.at) - there).norm(), 1e-12);
}

TEST(AlignSources, RigidKeepsTheSizeAndTranslationTheTurnToo) {
  Affine3d turned = similarity();
  turned.linear() /= 40;
  EXPECT_LT(apart(Pair(turned, Align::Rigid).aligned()), 1e-12);
  const AlignedSources larger = Pair(similarity(), Align::Rigid).aligned();
  const auto extent = [](const SourceMesh& source) {
    return (source.positions.rowwise() - source.positions.colwise().mean()).norm();
  };
  EXPECT_NEAR(extent(larger.sources[1]) / extent(larger.sources[0]), 40, 1e-9);
  const Affine3d moved(Eigen::Translation3d(9, 8, 7));
  EXPECT_LT(apart(Pair(moved, Align::Translation).aligned()), 1e-12);
  EXPECT_GT(apart(Pair(turned, Align::Translation).aligned()), 0.1);
}

TEST(AlignSources, AffineUndoesAStretch) {
  Affine3d map = similarity();
  map.linear() *= Vector3d(1, 3, 0.5).asDiagonal();
  EXPECT_LT(apart(Pair(map, Align::Affine).aligned()), 1e-10);
  EXPECT_GT(apart(Pair(map, Align::Similarity).aligned()), 0.1);
}

TEST(AlignSources, GoesByCentreAndSizeWithoutLandmarks) {
  Affine3d map(Eigen::Translation3d(5, 6, 7));
  map.scale(0.01);
  Pair pair(map, Align::Similarity);
  pair.recipe.sources[1].landmarks.resize(2);
  EXPECT_LT(apart(pair.aligned()), 1e-12);
}

TEST(AlignSources, RefusesLandmarksThatDoNotSayHow) {
  Pair few(similarity(), Align::Affine);
  few.recipe.sources[0].landmarks.resize(3);
  EXPECT_EQ(code_of(few), "landmarks.cannot-align");
  Pair line(similarity(), Align::Rigid);
  for (int i = 0; i < 4; ++i) {
    line.recipe.sources[0].landmarks[static_cast<std::size_t>(i)].at = Vector3d(i, 2 * i, 0);
  }
  EXPECT_EQ(code_of(line), "landmarks.cannot-align");
  Affine3d mirror = Affine3d::Identity();
  mirror.linear()(0, 0) = -1;
  EXPECT_EQ(code_of(Pair(mirror, Align::Affine)), "landmarks.cannot-align");
}

TEST(AlignSources, WarnsOfWhatNobodyWouldSee) {
  std::vector<std::string> warnings;
  Pair(similarity(), Align::None).aligned(&warnings);
  EXPECT_EQ(warnings, std::vector<std::string>{"sources.unlike"});
  warnings.clear();
  Pair(Affine3d(Eigen::Translation3d(50, 0, 0)), Align::None).aligned(&warnings);
  EXPECT_EQ(warnings, std::vector<std::string>{"sources.unlike"});
  warnings.clear();
  Pair(Affine3d(Eigen::Translation3d(1, 0, 0)), Align::None).aligned(&warnings);
  Pair(similarity(), Align::Similarity).aligned(&warnings);
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace morphbake
