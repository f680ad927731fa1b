#include "morphbake/transition/spread.h"

#include "morphbake/differential/laplacian.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/linear/unknowns.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {

Eigen::VectorXd spread_values(const Connectivity& connectivity,
                              const std::vector<FixedValue>& fixed) {
  const auto count = static_cast<std::size_t>(connectivity.vertex_count);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(connectivity.vertex_count);
  std::vector<bool> is_fixed(count, false);
  for (const FixedValue& each : fixed) {
    const auto vertex = static_cast<std::size_t>(each.vertex);
    if (!is_fixed[vertex]) values(each.vertex) = each.value;
    is_fixed[vertex] = true;
  }
  const Unknowns unknowns(is_fixed);
  if (unknowns.rows.empty()) return values;

  // Rows of K over the roots of their degrees; of its columns those of the unknowns.
  const OneRings rings = one_rings(connectivity);
  const Eigen::SparseMatrix<double> K = symmetric_laplacian(rings);
  const Eigen::VectorXd scale = K.diagonal().cwiseMax(1).cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> rows = scale.asDiagonal() * K;
  const Eigen::SparseMatrix<double> columns = rows * unknowns.selection();
  SymmetricSystem system;
  system.matrix = columns.transpose() * columns;
  system.singular_block.assign(unknowns.rows.size(), -1);
  const Eigen::MatrixXd b = -(columns.transpose() * (rows * values));
  values(unknowns.rows) = CholeskyFactor(system).solve(b).col(0);
  return values;
}

}  // namespace morphbake
