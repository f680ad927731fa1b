// A separable timeline is the timeline: fields times coefficients equal eq. 7 applied in order, and
// a combination of solved fields equals the solve of every frame.

#include "morphbake/transition/timeline.h"

#include <gtest/gtest.h>

#include "morphbake/mesh/measures.h"
#include "morphbake/solve/solve_fields.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

struct Scene {
  MorphableMesh mesh;
  Recipe recipe;
  RegionFields regions;
};

/// d by height: 0 above `inner`, 1 below `outer`.
Eigen::VectorXd band(const Positions& positions, int axis, double inner, double outer) {
  return ((positions.col(axis).array() - inner) / (outer - inner)).max(0).min(1);
}

Scene scene() {
  const Mesh mesh = test::sphere(20, 24);
  Scene made{test::morphable(mesh.triangles, {mesh.positions, test::bent(mesh.positions, 0.3, 1),
                                              test::bent(mesh.positions, 0.4, 2)}),
             {},
             {}};
  const Eigen::VectorXd top = band(mesh.positions, 1, 0.6, 0.1);
  const Eigen::VectorXd side = band(mesh.positions, 0, 0.5, -0.2);
  made.regions = fixed_fields({top, side, 1 - top.cwiseMin(side).array()});
  made.recipe.timeline.frames_per_second = 25;
  made.recipe.timeline.duration = 4;
  made.recipe.timeline.start = Eigen::Vector3d(1, 0, 0);
  return made;
}

// NOLINTNEXTLINE(readability-function-size): reads like a row of a table
Track track(const char* name, int region, Shares to, double begin, double end, Ease ease,
            double amount = 1) {
  return {name, {region, std::move(to), amount, Fit::None}, begin, end, ease};
}

Scene overlapping_tracks() {
  Scene made = scene();
  made.recipe.timeline.tracks = {
      track("top", 0, Eigen::Vector3d(0, 1, 0), 0.5, 2, Ease::Smoothstep),
      track("side", 1, Eigen::Vector3d(0.2, 0.3, 0.5), 1, 2.5, Ease::Cubic, 0.8),
      track("rest", 2, Eigen::Vector3d(0, 0, 1), 1.5, 3, Ease::Linear),
      track("flip", 0, Eigen::Vector3d(0.5, 0, 0.5), 3.2, 3.2, Ease::Step),
      track("all", -1, Eigen::Vector3d(0, 1, 0), 3.3, 4, Ease::Smoothstep),
  };
  return made;
}

Scene keyed_states() {
  Scene made = scene();
  made.recipe.states = {{"a", Eigen::Vector3d(1, 0, 0), {}},
                        {"top",
                         Eigen::Vector3d(1, 0, 0),
                         {{0, Eigen::Vector3d(0, 1, 0), 0.7}, {1, Eigen::Vector3d(0, 0, 1), 1}}},
                        {"mix", Eigen::Vector3d(0.2, 0.3, 0.5), {}}};
  made.recipe.timeline.keys = {{0, 0, Ease::Linear},
                               {1, 1, Ease::Smoothstep},
                               {2, 2, Ease::Step},
                               {3, 0, Ease::Cubic},
                               {4, 1, Ease::Linear}};
  return made;
}

class SeparableTimelines : public testing::TestWithParam<Scene (*)()> {};

TEST_P(SeparableTimelines, FieldsAddUpToTheState) {
  const Scene made = GetParam()();
  const Eigen::Index count = made.mesh.connectivity.vertex_count;
  const SeparableTimeline separable = *separate_timeline(made.recipe, made.regions, count);
  for (const double time : frame_times(made.recipe.timeline)) {
    const Eigen::VectorXd phi = field_coefficients(made.recipe.timeline, separable, time);
    Eigen::MatrixXd sum = uniform_transition(separable.reference, count);
    for (std::size_t k = 0; k < separable.fields.size(); ++k) {
      sum += phi(static_cast<Eigen::Index>(k)) * separable.fields[k].change;
    }
    const TransitionState T = transition_at(made.recipe, made.regions, count, time);
    EXPECT_LT((sum - T).cwiseAbs().maxCoeff(), 1e-13) << "at " << time;
    EXPECT_LT((T.colwise().sum().array() - 1).abs().maxCoeff(), 1e-13);
    EXPECT_GE(phi.minCoeff(), 0);
    EXPECT_LE(phi.maxCoeff(), 1);
  }
}

TEST_P(SeparableTimelines, CombinedShapesEqualSolvingEachFrame) {
  const Scene made = GetParam()();
  const Eigen::Index count = made.mesh.connectivity.vertex_count;
  const SeparableTimeline separable = *separate_timeline(made.recipe, made.regions, count);
  const Eigen::MatrixXd start = uniform_transition(separable.reference, count);
  const Observer nobody;
  for (const HoldRule rule : {HoldRule::Nothing, HoldRule::Untouched}) {
    const DisplacementSystem system(
        made.mesh,
        choose_constraints(made.mesh, connected_components(one_rings(made.mesh.connectivity)),
                           untouched_vertices(separable), {rule, {}, {}, -1}),
        RightHandSide::Edge);
    const SurfaceSolver solver(system, {}, nobody);
    const SolvedShapes shapes = solve_fields(solver, made.mesh, separable, nobody);
    for (const double time : frame_times(made.recipe.timeline)) {
      const Positions combined =
          combine_shapes(shapes, field_coefficients(made.recipe.timeline, separable, time));
      std::vector<SolveRecord> records;
      const Eigen::MatrixXd change = transition_at(made.recipe, made.regions, count, time) - start;
      const Positions solved = mixed_positions(made.mesh, separable.reference) +
                               solve_change(solver, change, "", records);
      EXPECT_LT(largest_distance(combined, solved), 1e-9 * system.diagonal()) << "at " << time;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Timelines, SeparableTimelines,
                         testing::Values(&overlapping_tracks, &keyed_states));

TEST(SeparableTimeline, TracksThatFollowOneAnotherNeedNoProducts) {
  Scene made = scene();
  made.recipe.timeline.tracks = {
      track("top", 0, Eigen::Vector3d(0, 1, 0), 0, 1, Ease::Smoothstep),
      track("side", 1, Eigen::Vector3d(0, 0, 1), 1, 2, Ease::Smoothstep),
      track("rest", 2, Eigen::Vector3d(0, 1, 0), 2, 3, Ease::Smoothstep)};
  const SeparableTimeline separable =
      *separate_timeline(made.recipe, made.regions, made.mesh.connectivity.vertex_count);
  EXPECT_EQ(separable.fields.size(), 4U);
}

}  // namespace
}  // namespace morphbake
