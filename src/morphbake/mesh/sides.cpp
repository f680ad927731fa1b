#include "morphbake/mesh/sides.h"

#include <array>
#include <numeric>

namespace morphbake {

std::vector<TriangleSide> sorted_sides(const Triangles& triangles) {
  const auto visit_sides = [&](const auto& visit) {
    for (int f = 0; f < triangles.rows(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const int a = triangles(f, k);
        const int b = triangles(f, (k + 1) % 3);
        if (a != b) visit(TriangleSide{std::min(a, b), std::max(a, b), a < b, f, k});
      }
    }
  };
  // Counted by their lower vertex first: a few sides each, quicker than sorting all of them.
  const int vertex_count = triangles.size() == 0 ? 0 : triangles.maxCoeff() + 1;
  std::vector<std::ptrdiff_t> ends(static_cast<std::size_t>(vertex_count) + 1, 0);
  visit_sides([&](const TriangleSide& side) { ++ends[static_cast<std::size_t>(side.low) + 1]; });
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<TriangleSide> sides(static_cast<std::size_t>(ends.back()));
  visit_sides([&](const TriangleSide& side) {
    sides[static_cast<std::size_t>(ends[static_cast<std::size_t>(side.low)]++)] = side;
  });
  auto begin = sides.begin();
  for (int v = 0; v < vertex_count; ++v) {
    const auto end = sides.begin() + ends[static_cast<std::size_t>(v)];
    std::sort(begin, end, [](const TriangleSide& a, const TriangleSide& b) {
      return std::array{a.high, a.triangle, a.corner} < std::array{b.high, b.triangle, b.corner};
    });
    begin = end;
  }
  return sides;
}

}  // namespace morphbake
