#include "morphbake/mesh/adjacency.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "morphbake/mesh/sides.h"

namespace morphbake {
namespace {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int find(int item) {
    while (parent_[static_cast<std::size_t>(item)] != item) {
      int& parent = parent_[static_cast<std::size_t>(item)];
      parent = parent_[static_cast<std::size_t>(parent)];
      item = parent;
    }
    return item;
  }

  void join(int a, int b) { parent_[static_cast<std::size_t>(find(a))] = find(b); }

 private:
  std::vector<int> parent_;
};

template <typename T>
void keep_first(std::vector<T>& list, const T& place, int limit) {
  if (static_cast<int>(list.size()) < limit) list.push_back(place);
}

/// Corners around one vertex belong to one fan when triangles connect them edge by edge.
std::vector<int> find_pinched_vertices(const Connectivity& connectivity,
                                       const std::vector<TriangleSide>& sides, int limit) {
  const Triangles& triangles = connectivity.triangles;
  DisjointSets fans(static_cast<std::size_t>(3 * triangles.rows()));
  const auto corner_of = [&](int f, int vertex) {
    for (int k = 0; k < 3; ++k) {
      if (triangles(f, k) == vertex) return 3 * f + k;
    }
    return -1;
  };
  for_each_edge(sides, [&](auto first, auto last) {
    for (auto side = first + 1; side < last; ++side) {
      for (const int vertex : {first->low, first->high}) {
        fans.join(corner_of(first->triangle, vertex), corner_of(side->triangle, vertex));
      }
    }
  });
  constexpr int kUnseen = -1, kPinched = -2;
  std::vector<int> fan_of(static_cast<std::size_t>(connectivity.vertex_count), kUnseen);
  std::vector<int> pinched;
  for (int corner = 0; corner < 3 * triangles.rows(); ++corner) {
    const int vertex = triangles(corner / 3, corner % 3);
    int& fan = fan_of[static_cast<std::size_t>(vertex)];
    if (fan == kUnseen) fan = fans.find(corner);
    if (fan == kPinched || fan == fans.find(corner)) continue;
    fan = kPinched;
    keep_first(pinched, vertex, limit);
  }
  return pinched;
}

}  // namespace

OneRings one_rings(const Connectivity& connectivity) {
  OneRings rings;
  rings.offsets.assign(static_cast<std::size_t>(connectivity.vertex_count) + 1, 0);
  const std::vector<TriangleSide> sides = sorted_sides(connectivity.triangles);
  std::vector<std::array<int, 2>> edges;
  for_each_edge(sides, [&](auto first, auto) {
    edges.push_back({first->low, first->high});
    edges.push_back({first->high, first->low});
  });
  std::sort(edges.begin(), edges.end());
  rings.neighbours.reserve(edges.size());
  for (const auto& [from, to] : edges) {
    ++rings.offsets[static_cast<std::size_t>(from) + 1];
    rings.neighbours.push_back(to);
  }
  std::partial_sum(rings.offsets.begin(), rings.offsets.end(), rings.offsets.begin());
  return rings;
}

Components connected_components(const OneRings& rings) {
  const std::size_t vertex_count = rings.offsets.size() - 1;
  Components components{std::vector<int>(vertex_count, -1), 0};
  std::vector<int> stack;
  for (std::size_t seed = 0; seed < vertex_count; ++seed) {
    if (components.label[seed] >= 0) continue;
    const int label = components.count++;
    components.label[seed] = label;
    stack.push_back(static_cast<int>(seed));
    while (!stack.empty()) {
      const auto vertex = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      for (int n = rings.offsets[vertex]; n < rings.offsets[vertex + 1]; ++n) {
        const int neighbour = rings.neighbours[static_cast<std::size_t>(n)];
        int& neighbour_label = components.label[static_cast<std::size_t>(neighbour)];
        if (neighbour_label >= 0) continue;
        neighbour_label = label;
        stack.push_back(neighbour);
      }
    }
  }
  return components;
}

bool ManifoldDefects::none() const {
  return degenerate_triangles.empty() && misoriented_triangles.empty() && crowded_edges.empty() &&
         pinched_vertices.empty() && unused_vertices.empty();
}

ManifoldDefects find_manifold_defects(const Connectivity& connectivity, int limit) {
  ManifoldDefects defects;
  std::vector<bool> used(static_cast<std::size_t>(connectivity.vertex_count), false);
  for (int f = 0; f < connectivity.triangles.rows(); ++f) {
    const Eigen::RowVector3i t = connectivity.triangles.row(f);
    if (t(0) == t(1) || t(1) == t(2) || t(2) == t(0))
      keep_first(defects.degenerate_triangles, f, limit);
    for (int k = 0; k < 3; ++k) used[static_cast<std::size_t>(t(k))] = true;
  }
  for (int v = 0; v < connectivity.vertex_count; ++v) {
    if (!used[static_cast<std::size_t>(v)]) keep_first(defects.unused_vertices, v, limit);
  }
  const std::vector<TriangleSide> sides = sorted_sides(connectivity.triangles);
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first > 2) {
      keep_first(defects.crowded_edges, Eigen::Vector2i(first->low, first->high), limit);
    } else if (last - first == 2 && first->forward == (first + 1)->forward) {
      keep_first(defects.misoriented_triangles, (first + 1)->triangle, limit);
    }
  });
  if (defects.degenerate_triangles.empty()) {
    defects.pinched_vertices = find_pinched_vertices(connectivity, sides, limit);
  }
  return defects;
}

}  // namespace morphbake
