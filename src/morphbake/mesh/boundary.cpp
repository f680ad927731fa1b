#include "morphbake/mesh/boundary.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace morphbake {
std::map<int, int> boundary_edges(const Triangles& triangles) {
  std::vector<std::array<int, 4>> sides;  // the vertices sorted, then as the triangle has them
  sides.reserve(static_cast<std::size_t>(triangles.size()));
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(f, k), b = triangles(f, (k + 1) % 3);
      sides.push_back({std::min(a, b), std::max(a, b), a, b});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::map<int, int> next;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto is_same = [&](std::size_t j) {
      return j < sides.size() && sides[i][0] == sides[j][0] && sides[i][1] == sides[j][1];
    };
    const bool has_twin = is_same(i + 1) || (i > 0 && is_same(i - 1));
    if (!has_twin) next[sides[i][2]] = sides[i][3];
  }
  return next;
}

std::vector<std::vector<int>> boundary_loops(const Triangles& triangles) {
  std::map<int, int> next = boundary_edges(triangles);
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int>& loop = loops.emplace_back();
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
      loop.push_back(at->second);
      next.erase(at);
    }
  }
  return loops;
}

std::vector<int> longest_boundary(const Mesh& mesh) {
  std::vector<int> longest;
  double longest_length = 0;
  for (std::vector<int>& loop : boundary_loops(mesh.triangles)) {
    double length = 0;
    int from = loop.back();
    for (const int to : loop) {
      length += (mesh.positions.row(from) - mesh.positions.row(to)).norm();
      from = to;
    }
    if (length <= longest_length) continue;
    longest_length = length;
    longest = std::move(loop);
  }
  return longest;
}

}  // namespace morphbake
