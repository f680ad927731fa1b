#include "morphbake/transition/harmonic.h"

#include <utility>

#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {

Eigen::VectorXd harmonic_values(const Connectivity& connectivity,
                                const std::vector<FixedValue>& fixed) {
  const OneRings rings = one_rings(connectivity);
  const auto count = static_cast<std::size_t>(connectivity.vertex_count);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(connectivity.vertex_count);
  std::vector<char> is_fixed(count, 0);
  for (const FixedValue& each : fixed) {
    char& known = is_fixed[static_cast<std::size_t>(each.vertex)];
    if (known == 0) values(each.vertex) = each.value;
    known = 1;
  }
  std::vector<int> unknown(count, -1), vertices;
  for (std::size_t v = 0; v < count; ++v) {
    if (is_fixed[v] != 0) continue;
    unknown[v] = static_cast<int>(vertices.size());
    vertices.push_back(static_cast<int>(v));
  }
  if (vertices.empty()) return values;

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(vertices.size()), 1);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto row = static_cast<int>(i);
    const auto v = static_cast<std::size_t>(vertices[i]);
    entries.emplace_back(row, row, rings.degree(vertices[i]));
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      const int j = rings.neighbours[static_cast<std::size_t>(n)];
      const int column = unknown[static_cast<std::size_t>(j)];
      if (column >= 0) {
        entries.emplace_back(row, column, -1.0);
      } else {
        b(row, 0) += values(j);
      }
    }
  }
  SymmetricSystem system;
  system.matrix.resize(b.rows(), b.rows());
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  system.singular_block.assign(vertices.size(), -1);
  values(vertices) = CholeskyFactor(system).solve(b).col(0);
  return values;
}

}  // namespace morphbake
