#include "morphbake/bake/anchor_spike.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace morphbake {
namespace {

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

}  // namespace

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

}  // namespace morphbake
