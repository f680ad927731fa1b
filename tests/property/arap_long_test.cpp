#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "morphbake/bake/connect_sources.h"
#include "morphbake/bake/load_sources.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/recipe/read_recipe.h"
#include "morphbake/solve/solve_fields.h"
#include "morphbake/solve/state_system.h"
#include "morphbake/sources/source_mesh.h"
#include "property/real_meshes.h"
#include "shapes/arap.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// How a shape on the way differs from the mix of the ends' edge lengths and triangle areas, root
/// mean square.
struct WayError {
  double edges = 0;
  double areas = 0;
};

WayError error_of(const MorphableMesh& mesh, const Positions& positions, double t) {
  const Positions &a = mesh.geometries[0], &b = mesh.geometries[1];
  const Triangles& triangles = mesh.connectivity.triangles;
  WayError error;
  double lengths = 0, areas = 0;
  for (const auto& f : triangles.rowwise()) {
    const auto edge = [&](const Positions& of, int k) -> Eigen::Vector3d {
      return of.row(f((k + 1) % 3)) - of.row(f(k));
    };
    const auto area = [&](const Positions& of) { return edge(of, 0).cross(edge(of, 1)).norm(); };
    for (int k = 0; k < 3; ++k) {
      const double expected = (1 - t) * edge(a, k).norm() + t * edge(b, k).norm();
      error.edges += std::pow(edge(positions, k).norm() - expected, 2);
      lengths += expected * expected;
    }
    const double expected = (1 - t) * area(a) + t * area(b);
    error.areas += std::pow(area(positions) - expected, 2);
    areas += expected * expected;
  }
  return {std::sqrt(error.edges / lengths), std::sqrt(error.areas / areas)};
}

/// Frames of the rotation-aware blend, nothing held.
std::vector<Positions> rotation_frames(const MorphableMesh& mesh,
                                       const std::vector<double>& times) {
  const Components components = connected_components(one_rings(mesh.connectivity));
  const std::vector<bool> untouched(static_cast<std::size_t>(mesh.connectivity.vertex_count));
  auto system = std::make_unique<DisplacementSystem>(
      mesh, choose_constraints(mesh, components, untouched, {HoldRule::Nothing, {}, {}, -1}),
      RightHandSide::Edge);
  const Observer nobody;
  const StateSystem states =
      rotation_states(mesh, std::make_shared<SourceDeformations>(source_deformations(mesh)),
                      Eigen::Vector2d(1, 0), std::move(system), {}, nobody);
  const SurfaceSolver solver(*states.displacements, {}, nobody);
  std::vector<Positions> frames;
  std::vector<SolveRecord> records;
  for (const double t : times) {
    const TransitionState T =
        uniform_transition(Eigen::Vector2d(1 - t, t), mesh.connectivity.vertex_count);
    frames.push_back(states.rest + solve_goal(solver, states.goal(T), "", records));
  }
  return frames;
}

/// Each frame from the one before.
std::vector<Positions> arap_frames(const MorphableMesh& mesh, const std::vector<double>& times) {
  const test::ArapInterpolation arap(mesh);
  std::vector<Positions> frames;
  for (const double t : times) {
    frames.push_back(arap.at(t, frames.empty() ? mesh.geometries[0] : frames.back()));
  }
  return frames;
}

void expect_as_good_as_arap(const MorphableMesh& mesh, const std::vector<double>& times) {
  const std::vector<Positions> ours = rotation_frames(mesh, times);
  const std::vector<Positions> arap = arap_frames(mesh, times);
  WayError our_worst, arap_worst;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const WayError own = error_of(mesh, ours[k], times[k]),
                   other = error_of(mesh, arap[k], times[k]);
    our_worst = {std::max(our_worst.edges, own.edges), std::max(our_worst.areas, own.areas)};
    arap_worst = {std::max(arap_worst.edges, other.edges), std::max(arap_worst.areas, other.areas)};
  }
  std::printf("edges %.6f (ARAP %.6f), areas %.6f (%.6f)\n", our_worst.edges, arap_worst.edges,
              our_worst.areas, arap_worst.areas);
  EXPECT_LT(our_worst.edges, 1.1 * arap_worst.edges);
  EXPECT_LT(our_worst.areas, 1.1 * arap_worst.areas);
}

struct Pose {
  double bend = 0;   ///< degrees over the whole length
  double twist = 0;  ///< likewise
};

class PosedCreatures : public testing::TestWithParam<Pose> {};

TEST_P(PosedCreatures, KeepsLengthsAndAreasAsWellAsArap) {
  const std::filesystem::path file =
      std::filesystem::path(MORPHBAKE_SOURCE_DIR) / "examples/shapes/creature_base.glb";
  MorphableMesh mesh = share_connectivity({load_source({"base", file, {}, {}})});
  Positions& base = mesh.geometries[0];
  const double low = base.col(1).minCoeff(), high = base.col(1).maxCoeff();
  base.rowwise() -= Eigen::RowVector3d(base.col(0).mean(), low, base.col(2).mean());
  base /= high - low;
  constexpr double kDegree = std::numbers::pi / 180;
  mesh.geometries.push_back(
      test::bent_and_twisted(base, GetParam().bend * kDegree, GetParam().twist * kDegree));
  mesh.names.emplace_back("posed");
  std::vector<double> times;
  for (int k = 1; k < 12; ++k) times.push_back(k / 12.0);
  expect_as_good_as_arap(mesh, times);
}

INSTANTIATE_TEST_SUITE_P(Rotation, PosedCreatures,
                         testing::Values(Pose{60, 0}, Pose{0, 90}, Pose{90, 90}));

/// A recipe of a pair of the team's meshes, which have landmarks of their own form.
Recipe recipe_of_pair(const std::string& name) {
  const std::filesystem::path meshes = std::filesystem::path(MORPHBAKE_SHARED_DIR) / "meshes";
  const auto pair = nlohmann::json::parse(std::ifstream(meshes / ("pair-" + name + ".json")));
  nlohmann::ordered_json recipe;
  recipe["version"] = 1;
  recipe["name"] = "pair";
  recipe["connectivity"] = {{"mode", "remesh"}, {"max_vertices", 6000}};
  for (const char* side : {"a", "b"}) {
    nlohmann::ordered_json& source = recipe["sources"][side];
    source["file"] = (meshes / pair[side].get<std::string>()).string();
    for (const auto& landmark : pair["landmarks"]) {
      source["landmarks"][landmark["name"].get<std::string>()] = {{"position", landmark[side]}};
    }
  }
  recipe["sources"]["b"]["align"] = "similarity";
  recipe["timeline"] = {{"keys", nlohmann::json::array({{{"time", 0}, {"state", "a"}},
                                                        {{"time", 1}, {"state", "b"}}})}};
  recipe["outputs"] = nlohmann::json::array({{{"file", "pair.glb"}}});
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "pair.json";
  std::ofstream(file) << recipe.dump();
  return read_recipe(file);
}

TEST(Rotation, KeepsLengthsAndAreasOfTwoMenAsWellAsArap) {
  if (!test::has_real_meshes()) GTEST_SKIP() << "needs the meshes of ../shared";
  const Observer nobody;
  AlignedSources loaded = load_aligned(recipe_of_pair("human_man--mh_male_young"), nobody);
  const StageCache none;
  BakeCache cache(none, loaded.recipe, nobody);
  const ConnectedSources connected =
      connect_sources(loaded.recipe, std::move(loaded.sources), Measuring::Off,
                      {cache, no_keys(loaded.recipe), nobody});
  expect_as_good_as_arap(share_connectivity(connected.sources), {0.25, 0.5, 0.75});
}

}  // namespace
}  // namespace morphbake
