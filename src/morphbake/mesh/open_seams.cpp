#include "morphbake/mesh/open_seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/sides.h"

namespace morphbake {
namespace {

constexpr double kBeside = 1e-6;  // of the diagonal
// Vertices that are looked at beside one: a seam has one or two, and where a whole part of the mesh
// is smaller than kBeside there are no seams to be told.
constexpr std::size_t kMostBeside = 8;

using Edge = std::pair<int, int>;

std::vector<Edge> boundary_of(const Triangles& triangles) {
  std::vector<Edge> edges;
  const std::vector<TriangleSide> sides = sorted_sides(triangles);
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first == 1) edges.emplace_back(first->low, first->high);
  });
  return edges;
}

/// Finds boundary vertices near one another, by cells of the first geometry.
class BoundaryVertices {
 public:
  BoundaryVertices(const std::vector<Edge>& edges, const std::vector<Positions>& geometries)
      : geometries_(geometries) {
    for (const Positions& positions : geometries) {
      reaches_.push_back(kBeside * bounding_diagonal(positions));
    }
    std::vector<int> vertices;
    for (const auto& [a, b] : edges) vertices.insert(vertices.end(), {a, b});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const int v : vertices) cells_[cell_of(geometries_[0].row(v))].push_back(v);
    beside_.resize(static_cast<std::size_t>(geometries_[0].rows()));
    for (const int v : vertices) beside_[static_cast<std::size_t>(v)] = find_beside(v);
  }

  /// The vertex itself and those that lie beside it in all geometries, rising.
  const std::vector<int>& beside(int vertex) const {
    return beside_[static_cast<std::size_t>(vertex)];
  }

  /// Whether an edge is long enough for its ends to be told apart.
  bool is_long(const Edge& edge) const {
    for (std::size_t g = 0; g < geometries_.size(); ++g) {
      if (!(distance(edge.first, edge.second, g) > 10 * reaches_[g])) return false;
    }
    return true;
  }

 private:
  using Cell = std::array<double, 3>;  // whole numbers, too large for int in a mesh far away

  /// Cells are twice as wide as vertices may lie apart: a neighbour is in one of eight.
  Cell cell_of(const Eigen::RowVector3d& position) const {
    const double side = reaches_[0] > 0 ? 2 * reaches_[0] : 1;
    return {std::floor(position(0) / side), std::floor(position(1) / side),
            std::floor(position(2) / side)};
  }

  std::vector<int> find_beside(int vertex) const {
    std::vector<int> found = {vertex};
    const Eigen::RowVector3d middle = geometries_[0].row(vertex);
    const Cell low = cell_of(middle.array() - reaches_[0]);
    const Cell high = cell_of(middle.array() + reaches_[0]);
    for (std::size_t i = 0; i < 8 && found.size() < kMostBeside; ++i) {
      Cell at;
      bool is_new = true;  // where both ends lie in one cell, that is looked at once
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool takes_high = (i >> axis & 1) != 0;
        at[axis] = takes_high ? high[axis] : low[axis];
        is_new = is_new && !(takes_high && low[axis] == high[axis]);
      }
      const auto cell = is_new ? cells_.find(at) : cells_.end();
      if (cell == cells_.end()) continue;
      const std::size_t looked_at = std::min(cell->second.size(), kMostBeside);
      for (std::size_t k = 0; k < looked_at; ++k) {
        const int other = cell->second[k];
        if (other != vertex && are_beside(vertex, other)) found.push_back(other);
      }
    }
    return found;
  }

  double distance(int a, int b, std::size_t g) const {
    return (geometries_[g].row(a) - geometries_[g].row(b)).norm();
  }

  bool are_beside(int a, int b) const {
    for (std::size_t g = 0; g < geometries_.size(); ++g) {
      if (distance(a, b, g) > reaches_[g]) return false;
    }
    return true;
  }

  const std::vector<Positions>& geometries_;
  std::vector<double> reaches_;
  std::map<Cell, std::vector<int>> cells_;
  std::vector<std::vector<int>> beside_;  // one a vertex: none for those inside
};

}  // namespace

std::vector<Eigen::Vector2i> find_open_seams(const Triangles& triangles,
                                             const std::vector<Positions>& geometries) {
  const std::vector<Edge> edges = boundary_of(triangles);
  const BoundaryVertices vertices(edges, geometries);
  std::vector<Eigen::Vector2i> seams;
  for (const Edge& edge : edges) {
    if (!vertices.is_long(edge)) continue;
    const std::vector<int>& beside_a = vertices.beside(edge.first);
    const std::vector<int>& beside_b = vertices.beside(edge.second);
    const bool has_twin = std::any_of(beside_a.begin(), beside_a.end(), [&](int a) {
      return std::any_of(beside_b.begin(), beside_b.end(), [&](int b) {
        const Edge other = std::minmax(a, b);
        return other != edge && std::binary_search(edges.begin(), edges.end(), other);
      });
    });
    if (has_twin) seams.emplace_back(edge.first, edge.second);
  }
  return seams;
}

}  // namespace morphbake
