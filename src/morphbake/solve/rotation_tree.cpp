#include "morphbake/solve/rotation_tree.h"

#include <algorithm>
#include <limits>

#include "morphbake/mesh/mesh.h"

namespace morphbake {
namespace {

/// One beside each of the rings' neighbours: edges are in the order of the neighbours behind their
/// first vertex, and of those before their second.
std::vector<int> edges_to_neighbours(const OneRings& rings, const std::vector<Edge>& edges) {
  std::vector<int> edge_to(rings.neighbours.size());
  std::vector<int> next = rings.offsets;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (const int end : {edges[e].a, edges[e].b}) {
      const int place = next[static_cast<std::size_t>(end)]++;
      edge_to[static_cast<std::size_t>(place)] = static_cast<int>(e);
    }
  }
  return edge_to;
}

/// What each vertex is turned by, unrolled: sums of the turns along a tree, as seen in space.
Positions unrolled(const Deformation& deformation, const std::vector<TreeStep>& tree) {
  Positions turned = Positions::Zero(static_cast<Eigen::Index>(deformation.rotations.size()), 3);
  for (const TreeStep& step : tree) {
    const int first = std::min(step.from, step.to);
    const Eigen::Vector3d turn = deformation.rotations[static_cast<std::size_t>(first)] *
                                 deformation.turns[static_cast<std::size_t>(step.edge)];
    turned.row(step.to) = turned.row(step.from);
    turned.row(step.to) += (step.from == first ? 1 : -1) * turn.transpose();
  }
  return turned;
}

}  // namespace

std::vector<TreeStep> tree_from(const OneRings& rings, const std::vector<Edge>& edges,
                                const std::vector<int>& starts) {
  const std::vector<int> edge_to = edges_to_neighbours(rings, edges);
  std::vector<bool> is_reached(rings.offsets.size() - 1, false);
  std::vector<int> open = starts;
  for (const int start : starts) is_reached[static_cast<std::size_t>(start)] = true;
  std::vector<TreeStep> tree;
  for (std::size_t next = 0; next < open.size(); ++next) {
    const int vertex = open[next];
    const auto v = static_cast<std::size_t>(vertex);
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      const auto place = static_cast<std::size_t>(n);
      const int neighbour = rings.neighbours[place];
      if (is_reached[static_cast<std::size_t>(neighbour)]) continue;
      is_reached[static_cast<std::size_t>(neighbour)] = true;
      tree.push_back({vertex, neighbour, edge_to[place]});
      open.push_back(neighbour);
    }
  }
  return tree;
}

std::vector<int> middle_vertices(const OneRings& rings, const Components& components,
                                 const std::vector<Edge>& edges,
                                 const std::vector<Deformation>& deformations,
                                 const Eigen::VectorXd& weights) {
  const auto count = static_cast<std::size_t>(components.count);
  const auto component_of = [&](Eigen::Index v) {
    return components.label[static_cast<std::size_t>(v)];
  };
  std::vector<int> middle(count, -1);
  for (Eigen::Index v = weights.size(); v-- > 0;) {
    middle[static_cast<std::size_t>(component_of(v))] = static_cast<int>(v);
  }
  const std::vector<TreeStep> tree = tree_from(rings, edges, middle);
  Eigen::VectorXd away = Eigen::VectorXd::Zero(weights.size());
  for (const Deformation& deformation : deformations) {
    const Positions turned = unrolled(deformation, tree);
    Positions means = Positions::Zero(components.count, 3);
    for (Eigen::Index v = 0; v < weights.size(); ++v) {
      means.row(component_of(v)) += weights(v) * turned.row(v);
    }
    for (Eigen::Index v = 0; v < weights.size(); ++v) {
      away(v) += (turned.row(v) - means.row(component_of(v))).squaredNorm();
    }
  }
  std::vector<double> least(count, std::numeric_limits<double>::infinity());
  for (Eigen::Index v = 0; v < weights.size(); ++v) {
    const auto component = static_cast<std::size_t>(component_of(v));
    if (!(weights(v) > 0) || away(v) >= least[component]) continue;
    least[component] = away(v);
    middle[component] = static_cast<int>(v);
  }
  return middle;
}

}  // namespace morphbake
