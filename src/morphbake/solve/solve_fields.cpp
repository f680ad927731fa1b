#include "morphbake/solve/solve_fields.h"

#include <fmt/core.h>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"
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

/// sum_s T_s V_s, vertex by vertex: what linear interpolation of positions would give.
Positions blend_positions(const std::vector<Positions>& geometries,
                          const Eigen::MatrixXd& weights) {
  Positions blended = Positions::Zero(weights.cols(), 3);
  for (std::size_t s = 0; s < geometries.size(); ++s) {
    const Eigen::VectorXd share = weights.row(static_cast<Eigen::Index>(s));
    blended += share.asDiagonal() * geometries[s];
  }
  return blended;
}

/// Translates every component of `positions` so that its weighted centroid is that of `reference`.
void align_centroids(const Components& components, const TranslationGauge& gauge,
                     const Positions& reference, Positions& positions) {
  Positions offsets = Positions::Zero(components.count, 3);
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    const int component = components.label[static_cast<std::size_t>(v)];
    offsets.row(component) += gauge.weights(v) * (reference.row(v) - positions.row(v));
  }
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    positions.row(v) += offsets.row(components.label[static_cast<std::size_t>(v)]);
  }
}

std::vector<bool> uniform_components(const Components& components, const Eigen::MatrixXd& weights) {
  std::vector<bool> uniform(static_cast<std::size_t>(components.count), true);
  std::vector<Eigen::Index> first(static_cast<std::size_t>(components.count), -1);
  for (Eigen::Index v = 0; v < weights.cols(); ++v) {
    const auto component = static_cast<std::size_t>(components.label[static_cast<std::size_t>(v)]);
    if (first[component] < 0) first[component] = v;
    if (weights.col(v) != weights.col(first[component])) uniform[component] = false;
  }
  return uniform;
}

}  // namespace

TranslationGauge choose_gauge(const MorphableMesh& mesh, const Components& components,
                              const std::vector<TransitionField>& fields) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.connectivity.vertex_count);
  for (const Positions& geometry : mesh.geometries)
    areas += vertex_areas(geometry, mesh.connectivity.triangles);
  // Surfaces without any area still have a centroid: that of their vertices.
  Eigen::VectorXd whole = sums_by_component(components, areas);
  for (Eigen::Index v = 0; v < areas.size(); ++v) {
    if (!(whole(components.label[static_cast<std::size_t>(v)]) > 0)) areas(v) = 1;
  }
  whole = sums_by_component(components, areas);
  Eigen::VectorXd untouched = areas;
  for (std::size_t k = 1; k < fields.size(); ++k) {
    for (Eigen::Index v = 0; v < areas.size(); ++v) {
      if (fields[k].weights.col(v).cwiseAbs().maxCoeff() > kUntouched) untouched(v) = 0;
    }
  }
  const Eigen::VectorXd reference = sums_by_component(components, untouched);
  TranslationGauge gauge{Eigen::VectorXd(areas.size())};
  for (Eigen::Index v = 0; v < areas.size(); ++v) {
    const int component = components.label[static_cast<std::size_t>(v)];
    const bool is_local = reference(component) >= kSmallestReference * whole(component);
    gauge.weights(v) = is_local ? untouched(v) / reference(component) : areas(v) / whole(component);
  }
  return gauge;
}

LaplacianSystem::LaplacianSystem(const MorphableMesh& mesh)
    : mesh_(mesh),
      rings_(one_rings(mesh.connectivity)),
      components_(connected_components(rings_)),
      factor_(symmetric_laplacian(rings_), components_) {}

Positions LaplacianSystem::solve(const Eigen::MatrixXd& weights,
                                 const TranslationGauge& gauge) const {
  const Positions b = blend_edge_differences(rings_, mesh_.geometries, weights);
  Positions solution = factor_.solve(b);
  align_centroids(components_, gauge, blend_positions(mesh_.geometries, weights), solution);
  if (!solution.allFinite()) {
    throw BakeError(Problem{Severity::Error,
                            "solve.not-finite",
                            {},
                            "the solved positions are not finite numbers",
                            "the sources' coordinates are too large for double precision"});
  }
  return solution;
}

Positions LaplacianSystem::solve_or_blend(const Eigen::MatrixXd& weights,
                                          const TranslationGauge& gauge) const {
  const std::vector<bool> uniform = uniform_components(components_, weights);
  const bool needs_solve = std::find(uniform.begin(), uniform.end(), false) != uniform.end();
  const Positions blended = blend_positions(mesh_.geometries, weights);
  if (!needs_solve) return blended;
  Positions solution = solve(weights, gauge);
  for (Eigen::Index v = 0; v < solution.rows(); ++v) {
    const int component = components_.label[static_cast<std::size_t>(v)];
    if (uniform[static_cast<std::size_t>(component)]) solution.row(v) = blended.row(v);
  }
  return solution;
}

SolvedShapes solve_fields(const LaplacianSystem& system, const SeparableTimeline& timeline,
                          const TranslationGauge& gauge) {
  SolvedShapes shapes;
  for (const TransitionField& field : timeline.fields) {
    Positions solved = system.solve_or_blend(field.weights, gauge);
    if (&field == &timeline.fields.front()) {
      shapes.base = std::move(solved);
    } else {
      shapes.names.push_back(field.name);
      shapes.displacements.push_back(std::move(solved));
    }
  }
  return shapes;
}

Positions combine_shapes(const SolvedShapes& shapes, const Eigen::VectorXd& phi) {
  Positions positions = shapes.base;
  for (std::size_t k = 0; k < shapes.displacements.size(); ++k) {
    const double share = phi(static_cast<Eigen::Index>(k) + 1);
    if (share != 0) positions += share * shapes.displacements[k];
  }
  return positions;
}

}  // namespace morphbake
