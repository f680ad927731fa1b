#include "morphbake/bake/timeline_system.h"

#include <fmt/core.h>

#include <utility>

#include "morphbake/json/json.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/surface_point.h"

namespace morphbake {
namespace {

constexpr double kInside = 1e-12;  // d of vertices that count as inside a held region

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

}  // namespace

std::unique_ptr<DisplacementSystem> timeline_system(const Recipe& recipe, const MorphableMesh& mesh,
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

}  // namespace morphbake
