#include "morphbake/solve/constraints.h"

#include <utility>

#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

/// A reference smaller than this share of its component would make the rest follow a detail.
constexpr double kSmallestReference = 0.05;

/// Shares that differ by no more than this are the same: edits that lead back leave rounding.
constexpr double kUntouched = 1e-12;

Eigen::VectorXd sums_by_component(const Components& components, const Eigen::VectorXd& values) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(components.count);
  for (Eigen::Index v = 0; v < values.size(); ++v) {
    sums(components.label[static_cast<std::size_t>(v)]) += values(v);
  }
  return sums;
}

/// Summed over the sources; components without any area count their vertices instead.
Eigen::VectorXd areas_of(const MorphableMesh& mesh, const Components& components) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.connectivity.vertex_count);
  for (const Positions& geometry : mesh.geometries) {
    areas += vertex_areas(geometry, mesh.connectivity.triangles);
  }
  const Eigen::VectorXd whole = sums_by_component(components, areas);
  for (Eigen::Index v = 0; v < areas.size(); ++v) {
    if (!(whole(components.label[static_cast<std::size_t>(v)]) > 0)) areas(v) = 1;
  }
  return areas;
}

Eigen::VectorXd masked(const Eigen::VectorXd& values, const std::vector<bool>& mask) {
  Eigen::VectorXd kept = values;
  for (Eigen::Index v = 0; v < kept.size(); ++v) {
    if (!mask[static_cast<std::size_t>(v)]) kept(v) = 0;
  }
  return kept;
}

/// Components of whose area enough is untouched to stand for them.
std::vector<bool> with_reference(const Components& components, const Eigen::VectorXd& areas,
                                 const Eigen::VectorXd& untouched_areas) {
  const Eigen::VectorXd whole = sums_by_component(components, areas);
  const Eigen::VectorXd reference = sums_by_component(components, untouched_areas);
  std::vector<bool> large;
  for (Eigen::Index c = 0; c < whole.size(); ++c) {
    large.push_back(reference(c) >= kSmallestReference * whole(c));
  }
  return large;
}

}  // namespace

void UntouchedVertices::add(const Eigen::MatrixXd& change) {
  const auto count = static_cast<Eigen::Index>(untouched_.size());
  for (Eigen::Index column = 0; column < change.cols(); ++column) {
    if (change.col(column).cwiseAbs().maxCoeff() > kUntouched) {
      untouched_[static_cast<std::size_t>(column % count)] = false;
    }
  }
}

std::vector<bool> untouched_vertices(const SeparableTimeline& timeline) {
  const Eigen::Index columns = timeline.fields.front().change.cols();
  UntouchedVertices untouched(columns / timeline.reference.cols());
  for (const TransitionField& field : timeline.fields) untouched.add(field.change);
  return untouched.mask();
}

Constraints choose_constraints(const MorphableMesh& mesh, const Components& components,
                               const std::vector<bool>& untouched,
                               const ConstraintRequest& request) {
  const Eigen::VectorXd areas = areas_of(mesh, components);
  const Eigen::VectorXd untouched_areas = masked(areas, untouched);
  const std::vector<bool> is_local = with_reference(components, areas, untouched_areas);
  const auto component_of = [&](Eigen::Index v) {
    return static_cast<std::size_t>(components.label[static_cast<std::size_t>(v)]);
  };
  const bool is_given = request.gauge_weights.size() > 0;
  const Eigen::VectorXd given =
      is_given ? request.gauge_weights : Eigen::VectorXd::Zero(areas.size());
  const Eigen::VectorXd given_sums = sums_by_component(components, given);

  Constraints constraints;
  constraints.held.assign(untouched.size(), false);
  constraints.gauge.resize(areas.size());
  constraints.anchor.assign(static_cast<std::size_t>(components.count), -1);
  for (Eigen::Index v = 0; v < areas.size(); ++v) {
    const std::size_t c = component_of(v);
    const auto vertex = static_cast<std::size_t>(v);
    const bool is_untouched = untouched[vertex] && is_local[c];
    constraints.held[vertex] = request.hold == HoldRule::Given
                                   ? request.held[vertex]
                                   : request.hold == HoldRule::Untouched && is_untouched;
    const bool follows_given = given_sums(static_cast<Eigen::Index>(c)) > 0;
    constraints.gauge(v) = follows_given ? given(v) : is_local[c] ? untouched_areas(v) : areas(v);
  }
  const Eigen::VectorXd sums = sums_by_component(components, constraints.gauge);
  for (Eigen::Index v = 0; v < areas.size(); ++v) {
    constraints.gauge(v) /= sums(static_cast<Eigen::Index>(component_of(v)));
  }
  if (request.anchor >= 0) constraints.anchor[component_of(request.anchor)] = request.anchor;
  return constraints;
}

}  // namespace morphbake
