#include "morphbake/bake/solve_timeline.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "morphbake/json/json.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/surface_point.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {
namespace {

constexpr double kInside = 1e-12;    // d of vertices that count as inside a held region
constexpr double kChanging = 1e-12;  // shares that differ by no more are the same

Eigen::VectorXd gauge_weights(const Recipe& recipe, const MorphableMesh& mesh,
                              const RegionFields& regions) {
  const Gauge& gauge = recipe.gauge;
  if (gauge.kind == Gauge::Kind::Auto) return {};
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(mesh.connectivity.vertex_count);
  if (gauge.kind == Gauge::Kind::Region) {
    for (const Positions& geometry : mesh.geometries) {
      weights += vertex_areas(geometry, mesh.connectivity.triangles);
    }
    return weights.array() * (1 - fixed_distance(regions, gauge.region).array());
  }
  const Mesh surface{mesh.geometries[static_cast<std::size_t>(gauge.source)],
                     mesh.connectivity.triangles};
  const SurfacePoint point = closest_point(surface, std::get<Eigen::Vector3d>(gauge.at));
  if (gauge.kind == Gauge::Kind::Anchor) {
    weights(nearest_corner(surface, point)) = 1;
    return weights;
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    weights(surface.triangles(point.triangle, k)) = point.barycentric(k);
  }
  return weights;
}

/// How the shares change over a timeline.
struct TimelineChanges {
  Shares reference;
  std::optional<SeparableTimeline> separable;      ///< none when regions move or flood
  std::function<Eigen::MatrixXd(double time)> at;  ///< from the reference
  std::vector<bool> untouched;                     ///< #V: at the reference at all times
  std::vector<double> first_change;  ///< #V without `separable`: of a frame, or -1 for never
};

bool is_changed(const Eigen::MatrixXd& change, Eigen::Index vertex, Eigen::Index count) {
  for (Eigen::Index column = vertex; column < change.cols(); column += count) {
    if (change.col(column).cwiseAbs().maxCoeff() > kChanging) return true;
  }
  return false;
}

/// What changes a vertex's shares over the timeline, or "".
std::string changed_by(const TimelineChanges& changes, Eigen::Index vertex) {
  const auto count = static_cast<Eigen::Index>(changes.untouched.size());
  if (!changes.separable) {
    const double time = changes.first_change[static_cast<std::size_t>(vertex)];
    return time < 0 ? "" : fmt::format("the timeline at {:.4g} s", time);
  }
  const std::vector<TransitionField>& fields = changes.separable->fields;
  for (std::size_t k = 1; k < fields.size(); ++k) {
    if (is_changed(fields[k].change, vertex, count)) return fmt::format("\"{}\"", fields[k].name);
  }
  return "";
}

TimelineChanges changes_of_fields(SeparableTimeline separable) {
  TimelineChanges changes;
  changes.reference = separable.reference;
  changes.untouched = untouched_vertices(separable);
  changes.separable = std::move(separable);
  return changes;
}

/// Looks at every frame: where fields are not known there is no other way.
void survey_frames(const Timeline& timeline, Eigen::Index count, const Observer& observer,
                   TimelineChanges& changes) {
  UntouchedVertices untouched(count);
  changes.first_change.assign(static_cast<std::size_t>(count), -1);
  Eigen::MatrixXd start;
  for (const double time : frame_times(timeline)) {
    stop_if_cancelled(observer);
    const Eigen::MatrixXd change = changes.at(time);
    untouched.add(change);
    if (start.size() == 0) start = change;
    const Eigen::MatrixXd moved = change - start;
    for (Eigen::Index v = 0; v < count; ++v) {
      double& first = changes.first_change[static_cast<std::size_t>(v)];
      if (first < 0 && is_changed(moved, v, count)) first = time;
    }
  }
  changes.untouched = untouched.mask();
}

Shares start_of(const Recipe& recipe) {
  const Timeline& timeline = recipe.timeline;
  if (timeline.keys.empty()) return timeline.start;
  return recipe.states[static_cast<std::size_t>(timeline.keys.front().state)].mix;
}

TimelineChanges changes_of(const Recipe& recipe, const RegionFields& regions, Eigen::Index count,
                           std::optional<SeparableTimeline> separable, const Observer& observer) {
  TimelineChanges changes;
  if (separable) {
    changes = changes_of_fields(std::move(*separable));
  } else {
    changes.reference = start_of(recipe);
  }
  changes.at = [&recipe, &regions, count,
                start = uniform_transition(changes.reference, count)](double time) {
    return Eigen::MatrixXd(transition_at(recipe, regions, count, time) - start);
  };
  if (!changes.separable) survey_frames(recipe.timeline, count, observer, changes);
  return changes;
}

std::vector<bool> held_vertices(const Recipe& recipe, const RegionFields& regions,
                                const TimelineChanges& changes) {
  std::vector<bool> held(changes.untouched.size(), false);
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < recipe.hold.regions.size(); ++i) {
    const int region = recipe.hold.regions[i];
    const Eigen::VectorXd& d = fixed_distance(regions, region);
    std::string culprit;
    for (Eigen::Index v = 0; v < d.size(); ++v) {
      if (d(v) > kInside) continue;
      held[static_cast<std::size_t>(v)] = true;
      if (culprit.empty()) culprit = changed_by(changes, v);
    }
    if (culprit.empty()) continue;
    problems.push_back({Severity::Error, "recipe.held-region-changes",
                        location_in(recipe, child_pointer("/hold", i)),
                        fmt::format("the region {} is held, but {} changes vertices inside of it",
                                    recipe.regions[static_cast<std::size_t>(region)].name, culprit),
                        "hold a smaller region, or let the edit's region end before it"});
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return held;
}

ConstraintRequest requested_constraints(const Recipe& recipe, const MorphableMesh& mesh,
                                        const RegionFields& regions,
                                        const TimelineChanges& changes) {
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
    request.held = held_vertices(recipe, regions, changes);
  }
  return request;
}

std::unique_ptr<DisplacementSystem> make_system(const Recipe& recipe, const MorphableMesh& mesh,
                                                const RegionFields& regions,
                                                const TimelineChanges& changes,
                                                const SolveOptions& options) {
  const Components components = connected_components(one_rings(mesh.connectivity));
  Constraints constraints = choose_constraints(
      mesh, components, changes.untouched, requested_constraints(recipe, mesh, regions, changes));
  // The anchor is the paper's, whose right-hand side is eq. 6.
  const bool is_anchored = recipe.gauge.kind == Gauge::Kind::Anchor;
  return std::make_unique<DisplacementSystem>(
      mesh, std::move(constraints), is_anchored ? RightHandSide::Vertex : options.right_hand_side);
}

StateSystem make_states(const MorphableMesh& mesh, const Shares& reference,
                        const RepresentationChoice& choice,
                        std::unique_ptr<DisplacementSystem> system, const SolveOptions& options,
                        const Observer& observer) {
  switch (choice.representation) {
    case Representation::Rotation:
      return rotation_states(mesh, choice.deformations, reference, std::move(system), options,
                             observer);
    case Representation::Affine:
      return affine_states(mesh, reference, std::move(system));
    case Representation::Absolute:
      return absolute_states(mesh, reference, std::move(system));
    case Representation::Rigid:
      return rigid_states(mesh, reference, std::move(system));
    default:
      return laplacian_states(mesh, reference, std::move(system));
  }
}

/// Refuses targets that are shapes, for a reason: without shapes there are only frames.
void refuse_tracks(const Recipe& recipe, const std::string& reason) {
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    const Output& output = recipe.outputs[i];
    if (output.still || output.targets != TargetKind::Tracks) continue;
    throw BakeError(Problem{Severity::Error, "recipe.needs-frames",
                            location_in(recipe, child_pointer("/outputs", i) + "/targets"),
                            "\"tracks\" targets are shapes that are solved once; " + reason,
                            "write \"targets\": \"frames\""});
  }
}

/// What must stand still: held and gauge regions, and regions of states that become stills.
void check_still_regions(const Recipe& recipe, const RegionFields& regions) {
  std::vector<Problem> problems;
  const auto check = [&](int region, bool may_flood, const std::string& pointer) {
    if (region < 0) return;
    const RegionField& field = regions[static_cast<std::size_t>(region)];
    if (!field.moves && (may_flood || !field.floods)) return;
    problems.push_back(
        {Severity::Error, "recipe.moving-region", location_in(recipe, pointer),
         fmt::format("the region {} changes with time", recipe.regions[region].name),
         "name a region that stands still here; a still may name a time instead of a state"});
  };
  for (std::size_t i = 0; i < recipe.hold.regions.size(); ++i) {
    check(recipe.hold.regions[i], false, child_pointer("/hold", i));
  }
  if (recipe.gauge.kind == Gauge::Kind::Region) check(recipe.gauge.region, false, "/gauge/region");
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    const auto& still = recipe.outputs[i].still;
    if (!still || !std::holds_alternative<int>(still->at)) continue;
    for (const Edit& edit :
         recipe.states[static_cast<std::size_t>(std::get<int>(still->at))].edits) {
      check(edit.region, true, child_pointer("/outputs", i) + "/still/at");
    }
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
}

/// The options, with every frame solved where there is no other way.
SolveOptions options_for(Representation representation, const TimelineChanges& changes,
                         SolveOptions options) {
  options.every_frame =
      options.every_frame || !changes.separable || representation != Representation::Laplacian;
  return options;
}

/// The timeline as shapes, where it is made of them, once all is checked.
std::optional<SeparableTimeline> shapes_of(const Recipe& recipe, const RegionFields& regions,
                                           Eigen::Index count, Representation representation,
                                           const SolveOptions& options, const Observer& observer) {
  check_still_regions(recipe, regions);
  if (options.every_frame) {
    refuse_tracks(recipe, "the option /solve/every_frame solves frames instead");
  }
  if (!is_separable(recipe, regions)) {
    refuse_tracks(recipe, "here a region moves or floods, so every frame is another");
    return std::nullopt;
  }
  if (representation != Representation::Laplacian) {
    refuse_tracks(recipe, fmt::format("the representation \"{}\" solves every frame",
                                      name_of(representation)));
  }
  std::optional<SeparableTimeline> separable = separate_timeline(recipe, regions, count);
  if (separable) return separable;
  const std::string reason = fmt::format(
      "more than {} are needed here: one a track, and one for each combination of "
      "tracks that overlap in space and time",
      kMostFields - 1);
  refuse_tracks(recipe, reason);
  report(observer,
         Problem{Severity::Warning, "transition.too-many-overlaps",
                 location_in(recipe, "/timeline/tracks"),
                 "frames are solved instead of tracks' shapes: " + reason,
                 "use fewer tracks, and let those that share a region follow one another"});
  return std::nullopt;
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

/// What was put into the anchor's equation at `time`.
using ImbalanceAt = std::function<Eigen::RowVector3d(double time)>;

ImbalanceAt imbalance_of(const Recipe& recipe, const SolvedTimeline& solved,
                         const TimelineChanges& changes, int component) {
  const DisplacementSystem& system = *solved.states->displacements;
  if (!solved.separable) {
    return [&system, &changes, component](double time) -> Eigen::RowVector3d {
      return system.goal(changes.at(time)).imbalance.row(component);
    };
  }
  std::vector<Eigen::RowVector3d> imbalances;
  for (const TransitionField& field : solved.separable->fields) {
    imbalances.emplace_back(system.goal(field.change).imbalance.row(component));
  }
  return [&recipe, &solved, imbalances](double time) {
    const Eigen::VectorXd phi = field_coefficients(recipe.timeline, *solved.separable, time);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::size_t k = 0; k < imbalances.size(); ++k) {
      sum += phi(static_cast<Eigen::Index>(k)) * imbalances[k];
    }
    return sum;
  };
}

/// The anchor's own equation is not met: by how much, that is how far the vertex stands out of its
/// neighbours.
void warn_of_spike(const Recipe& recipe, const MorphableMesh& mesh, const SolvedTimeline& solved,
                   const TimelineChanges& changes, const Observer& observer) {
  int anchor = -1;
  for (const int each : solved.states->displacements->constraints().anchor)
    anchor = std::max(anchor, each);
  if (anchor < 0) return;
  const int component =
      solved.states->displacements->components().label[static_cast<std::size_t>(anchor)];
  const ImbalanceAt imbalance_at = imbalance_of(recipe, solved, changes, component);
  double largest = 0, when = 0;
  for (const double time : frame_times(recipe.timeline)) {
    stop_if_cancelled(observer);
    const double imbalance = imbalance_at(time).norm();
    if (imbalance <= largest) continue;
    largest = imbalance;
    when = time;
  }
  const int degree = one_rings(mesh.connectivity).degree(anchor);
  const double edge = mean_edge(mesh, mesh.geometries[0]);
  const double edges = edge > 0 ? largest / degree / edge : 0;
  report(observer,
         Problem{Severity::Warning, "solve.anchor-spike", location_in(recipe, "/gauge/anchor"),
                 fmt::format("the anchored vertex stands {:.2g} edge lengths out of its neighbours "
                             "at {:.3g} s: its equation was dropped, and took the whole imbalance",
                             edges, when),
                 "leave \"gauge\" out; an anchor is for comparison with the paper only"});
}

SolveReport report_of(const SolvedTimeline& solved, std::vector<SolveRecord> records) {
  const DisplacementSystem& system = *solved.states->displacements;
  SolveReport report;
  report.representation = name_of(solved.representation.representation);
  report.representation_reason = solved.representation.reason;
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

void check_timeline(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                    const SolveOptions& options, const Observer& observer) {
  const Eigen::Index count = mesh.connectivity.vertex_count;
  const Representation representation =
      choose_representation(recipe, mesh, observer).representation;
  const TimelineChanges changes =
      changes_of(recipe, regions, count,
                 shapes_of(recipe, regions, count, representation, options, observer), observer);
  choose_solver(*make_system(recipe, mesh, regions, changes, options),
                options_for(representation, changes, options));
}

std::unique_ptr<SolvedTimeline> solve_timeline(const Recipe& recipe, const MorphableMesh& mesh,
                                               const RegionFields& regions,
                                               const SolveOptions& options,
                                               const Observer& observer) {
  const Eigen::Index count = mesh.connectivity.vertex_count;
  auto solved = std::make_unique<SolvedTimeline>();
  solved->representation = choose_representation(recipe, mesh, observer);
  const Representation representation = solved->representation.representation;
  TimelineChanges changes =
      changes_of(recipe, regions, count,
                 shapes_of(recipe, regions, count, representation, options, observer), observer);
  solved->states = std::make_unique<StateSystem>(
      make_states(mesh, changes.reference, solved->representation,
                  make_system(recipe, mesh, regions, changes, options), options, observer));
  const SolveOptions solving = options_for(representation, changes, options);
  const StateSystem& states = *solved->states;
  solved->separable = std::move(changes.separable);
  solved->solver = std::make_unique<SurfaceSolver>(*states.displacements, solving, observer);
  std::vector<SolveRecord> records;
  if (!solving.every_frame) {
    solved->shapes = solve_fields(*solved->solver, mesh, *solved->separable, observer);
    solved->frames = combined_frames(solved->shapes, *solved->separable, recipe.timeline);
    records = solved->shapes.records;
  } else {
    const auto goals_at = [&](std::span<const double> times) {
      std::vector<TransitionState> moments;
      for (const double time : times) {
        moments.push_back(transition_at(recipe, regions, count, time));
      }
      return states.goals(moments);
    };
    SolvedFrames frames = solved_frames(*solved->solver, states.rest, frame_times(recipe.timeline),
                                        goals_at, observer);
    solved->frames = std::move(frames.source);
    records = std::move(frames.records);
  }
  warn_of_spike(recipe, mesh, *solved, changes, observer);
  solved->report = report_of(*solved, std::move(records));
  return solved;
}

Positions position_at(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                      const SolvedTimeline& solved, double time) {
  if (solved.shapes.base.rows() > 0) {
    return combine_shapes(solved.shapes,
                          field_coefficients(recipe.timeline, *solved.separable, time));
  }
  const Eigen::Index count = mesh.connectivity.vertex_count;
  std::vector<SolveRecord> records;
  return solved.states->rest +
         solve_goal(*solved.solver,
                    solved.states->goal(transition_at(recipe, regions, count, time)), "", records);
}

Positions solve_state(const Recipe& recipe, const State& state, const MorphableMesh& mesh,
                      const RegionFields& regions, const RepresentationChoice& representation,
                      const SolveOptions& options) {
  const Eigen::Index count = mesh.connectivity.vertex_count;
  const TimelineChanges changes = changes_of_fields(separate_state(state, regions, count));
  const Observer nobody;
  const StateSystem states =
      make_states(mesh, changes.reference, representation,
                  make_system(recipe, mesh, regions, changes, options), options, nobody);
  const SurfaceSolver solver(*states.displacements, options, nobody);
  std::vector<SolveRecord> records;
  return states.rest + solve_goal(solver, states.goal(state_transition(state, regions, count)),
                                  state.name, records);
}

}  // namespace morphbake
