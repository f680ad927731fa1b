#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>

#include "morphbake/mesh/measures.h"
#include "morphbake/solve/solve_fields.h"
#include "morphbake/solve/state_system.h"
#include "morphbake/sources/source_mesh.h"
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

void expect_as_good_as_arap(const MorphableMesh& mesh) {
  std::vector<double> times;
  for (int k = 1; k < 12; ++k) times.push_back(k / 12.0);
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
  expect_as_good_as_arap(mesh);
}

INSTANTIATE_TEST_SUITE_P(Rotation, PosedCreatures,
                         testing::Values(Pose{60, 0}, Pose{0, 90}, Pose{90, 90}));

}  // namespace
}  // namespace morphbake
