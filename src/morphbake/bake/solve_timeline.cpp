#include "morphbake/bake/solve_timeline.h"

#include <fmt/core.h>

#include <utility>

#include "morphbake/json/json.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

constexpr double kInside = 1e-12;    // d of vertices that count as inside a held region
constexpr double kChanging = 1e-12;  // shares that differ by no more are the same

SurfacePoint point_of(const MorphableMesh& mesh, const Gauge& gauge) {
  const Mesh surface{mesh.geometries[static_cast<std::size_t>(gauge.source)],
                     mesh.connectivity.triangles};
  return closest_point(surface, std::get<Eigen::Vector3d>(gauge.at));
}

Eigen::VectorXd gauge_weights(const Recipe& recipe, const MorphableMesh& mesh,
                              const std::vector<Eigen::VectorXd>& regions) {
  const Gauge& gauge = recipe.gauge;
  if (gauge.kind == Gauge::Kind::Auto) return {};
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(mesh.connectivity.vertex_count);
  if (gauge.kind == Gauge::Kind::Region) {
    for (const Positions& geometry : mesh.geometries) {
      weights += vertex_areas(geometry, mesh.connectivity.triangles);
    }
    return weights.array() * (1 - regions[static_cast<std::size_t>(gauge.region)].array());
  }
  const SurfacePoint point = point_of(mesh, gauge);
  Eigen::Index strongest = 0;
  point.barycentric.maxCoeff(&strongest);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const int vertex = mesh.connectivity.triangles(point.triangle, k);
    const bool is_anchor = gauge.kind == Gauge::Kind::Anchor;
    weights(vertex) = is_anchor ? (k == strongest ? 1 : 0) : point.barycentric(k);
  }
  return weights;
}

/// What changes a vertex's shares over the timeline, or "".
std::string changed_by(const SeparableTimeline& separable, std::size_t vertex) {
  for (std::size_t k = 1; k < separable.fields.size(); ++k) {
    const auto change = separable.fields[k].change.col(static_cast<Eigen::Index>(vertex));
    if (change.cwiseAbs().maxCoeff() > kChanging) return separable.fields[k].name;
  }
  return "";
}

std::vector<bool> held_vertices(const Recipe& recipe, const std::vector<Eigen::VectorXd>& regions,
                                const SeparableTimeline& separable) {
  std::vector<bool> held(static_cast<std::size_t>(separable.fields[0].change.cols()), false);
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < recipe.hold.regions.size(); ++i) {
    const auto region = static_cast<std::size_t>(recipe.hold.regions[i]);
    std::string culprit;
    for (std::size_t v = 0; v < held.size(); ++v) {
      if (regions[region](static_cast<Eigen::Index>(v)) > kInside) continue;
      held[v] = true;
      if (culprit.empty()) culprit = changed_by(separable, v);
    }
    if (culprit.empty()) continue;
    problems.push_back(
        {Severity::Error,
         "recipe.held-region-changes",
         {recipe.file.string(), child_pointer("/hold", i), 0, 0},
         fmt::format("the region {} is held, but \"{}\" changes vertices inside of it",
                     recipe.regions[region].name, culprit),
         "hold a smaller region, or let the edit's region end before it"});
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return held;
}

ConstraintRequest requested_constraints(const Recipe& recipe, const MorphableMesh& mesh,
                                        const std::vector<Eigen::VectorXd>& regions,
                                        const SeparableTimeline& separable) {
  ConstraintRequest request;
  request.gauge_weights = gauge_weights(recipe, mesh, regions);
  if (recipe.gauge.kind == Gauge::Kind::Anchor) {
    Eigen::Index anchor = 0;
    request.gauge_weights.maxCoeff(&anchor);
    request.anchor = static_cast<int>(anchor);
  }
  if (recipe.hold.rule == Hold::Rule::None) request.hold = HoldRule::Nothing;
  if (recipe.hold.rule == Hold::Rule::Regions) {
    request.hold = HoldRule::Given;
    request.held = held_vertices(recipe, regions, separable);
  }
  return request;
}

std::unique_ptr<DisplacementSystem> make_system(const Recipe& recipe, const MorphableMesh& mesh,
                                                const std::vector<Eigen::VectorXd>& regions,
                                                const SeparableTimeline& separable,
                                                RightHandSide rule) {
  const Components components = connected_components(one_rings(mesh.connectivity));
  Constraints constraints =
      choose_constraints(mesh, components, untouched_vertices(separable),
                         requested_constraints(recipe, mesh, regions, separable));
  // The anchor is the paper's, whose right-hand side is eq. 6.
  const bool is_anchored = recipe.gauge.kind == Gauge::Kind::Anchor;
  return std::make_unique<DisplacementSystem>(mesh, std::move(constraints),
                                              is_anchored ? RightHandSide::Vertex : rule);
}

void check_every_frame(const Recipe& recipe) {
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    const Output& output = recipe.outputs[i];
    if (output.still || output.targets == TargetKind::Frames) continue;
    throw BakeError(Problem{Severity::Error,
                            "recipe.needs-frames",
                            {recipe.file.string(), child_pointer("/outputs", i), 0, 0},
                            "\"tracks\" targets are shapes that are solved once; the option "
                            "/solve/every_frame solves frames instead",
                            "write \"targets\": \"frames\", or leave every_frame out"});
  }
}

double mean_edge(const MorphableMesh& mesh, const Positions& positions) {
  double sum = 0;
  const Triangles& triangles = mesh.connectivity.triangles;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      sum += (positions.row(triangles(f, k)) - positions.row(triangles(f, (k + 1) % 3))).norm();
    }
  }
  return triangles.rows() == 0 ? 0 : sum / static_cast<double>(triangles.size());
}

/// The anchor's own equation is not met: by how much, that is how far the vertex stands out of its
/// neighbours.
void warn_of_spike(const Recipe& recipe, const MorphableMesh& mesh, const SolvedTimeline& solved,
                   const Observer& observer) {
  int anchor = -1;
  for (const int each : solved.system->constraints().anchor) anchor = std::max(anchor, each);
  if (anchor < 0) return;
  const int component = solved.system->components().label[static_cast<std::size_t>(anchor)];
  std::vector<Eigen::RowVector3d> imbalances;
  for (const TransitionField& field : solved.separable.fields) {
    imbalances.emplace_back(solved.system->goal(field.change).imbalance.row(component));
  }
  double largest = 0, when = 0;
  for (const double time : frame_times(recipe.timeline)) {
    const Eigen::VectorXd phi = field_coefficients(recipe.timeline, solved.separable, time);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::size_t k = 0; k < imbalances.size(); ++k) {
      sum += phi(static_cast<Eigen::Index>(k)) * imbalances[k];
    }
    if (sum.norm() <= largest) continue;
    largest = sum.norm();
    when = time;
  }
  const int degree = one_rings(mesh.connectivity).degree(anchor);
  const double edge = mean_edge(mesh, mesh.geometries[0]);
  const double edges = edge > 0 ? largest / degree / edge : 0;
  report(observer,
         Problem{Severity::Warning,
                 "solve.anchor-spike",
                 {recipe.file.string(), "/gauge/anchor", 0, 0},
                 fmt::format("the anchored vertex stands {:.2g} edge lengths out of its neighbours "
                             "at {:.3g} s: its equation was dropped, and took the whole imbalance",
                             edges, when),
                 "leave \"gauge\" out; an anchor is for comparison with the paper only"});
}

SolveReport report_of(const SolvedTimeline& solved, std::vector<SolveRecord> records) {
  const DisplacementSystem& system = *solved.system;
  SolveReport report;
  report.solver = name_of(solved.solver->choice().solver);
  report.reason = solved.solver->choice().reason;
  report.unknowns = static_cast<int>(system.equations().matrix.rows());
  report.held = system.held_count();
  report.factor_bytes = solved.solver->factor_bytes();
  report.solves = std::move(records);
  if (system.diagonal() > 0) {
    for (SolveRecord& record : report.solves) record.convergence.error /= system.diagonal();
  }
  return report;
}

}  // namespace

void check_timeline(const Recipe& recipe, const MorphableMesh& mesh,
                    const std::vector<Eigen::VectorXd>& regions, const SolveOptions& options) {
  if (options.every_frame) check_every_frame(recipe);
  const SeparableTimeline separable =
      separate_timeline(recipe, regions, mesh.connectivity.vertex_count);
  const auto system = make_system(recipe, mesh, regions, separable, options.right_hand_side);
  choose_solver(*system, options);
}

std::unique_ptr<SolvedTimeline> solve_timeline(const Recipe& recipe, const MorphableMesh& mesh,
                                               const std::vector<Eigen::VectorXd>& regions,
                                               const SolveOptions& options,
                                               const Observer& observer) {
  if (options.every_frame) check_every_frame(recipe);
  auto solved = std::make_unique<SolvedTimeline>();
  const Eigen::Index count = mesh.connectivity.vertex_count;
  solved->separable = separate_timeline(recipe, regions, count);
  const SeparableTimeline& separable = solved->separable;
  solved->system = make_system(recipe, mesh, regions, separable, options.right_hand_side);
  solved->solver = std::make_unique<SurfaceSolver>(*solved->system, options, observer);
  std::vector<SolveRecord> records;
  if (options.every_frame) {
    const Eigen::MatrixXd start = uniform_transition(separable.reference, count);
    const auto change_at = [&, start](double time) -> Eigen::MatrixXd {
      return transition_at(recipe, regions, count, time) - start;
    };
    SolvedFrames frames =
        solved_frames(*solved->solver, reference_positions(mesh, separable.reference),
                      frame_times(recipe.timeline), change_at, observer);
    solved->frames = std::move(frames.source);
    records = std::move(frames.records);
  } else {
    solved->shapes = solve_fields(*solved->solver, mesh, separable, observer);
    solved->frames = combined_frames(solved->shapes, separable, recipe.timeline);
    records = solved->shapes.records;
  }
  warn_of_spike(recipe, mesh, *solved, observer);
  solved->report = report_of(*solved, std::move(records));
  return solved;
}

Positions position_at(const Recipe& recipe, const MorphableMesh& mesh,
                      const std::vector<Eigen::VectorXd>& regions, const SolvedTimeline& solved,
                      double time) {
  const SeparableTimeline& separable = solved.separable;
  if (solved.shapes.base.rows() > 0) {
    return combine_shapes(solved.shapes, field_coefficients(recipe.timeline, separable, time));
  }
  const Eigen::Index count = mesh.connectivity.vertex_count;
  const Eigen::MatrixXd change =
      transition_at(recipe, regions, count, time) - uniform_transition(separable.reference, count);
  std::vector<SolveRecord> records;
  return reference_positions(mesh, separable.reference) +
         solve_change(*solved.solver, change, "", records);
}

Positions solve_state(const Recipe& recipe, const State& state, const MorphableMesh& mesh,
                      const std::vector<Eigen::VectorXd>& regions, const SolveOptions& options) {
  const Eigen::Index count = mesh.connectivity.vertex_count;
  const SeparableTimeline alone = separate_state(state, regions, count);
  const auto system = make_system(recipe, mesh, regions, alone, options.right_hand_side);
  const Observer nobody;
  const SurfaceSolver solver(*system, options, nobody);
  std::vector<SolveRecord> records;
  return reference_positions(mesh, alone.reference) +
         solve_change(solver, alone.fields[0].change, state.name, records);
}

}  // namespace morphbake
