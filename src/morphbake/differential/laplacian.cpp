#include "morphbake/differential/laplacian.h"

namespace morphbake {

Positions differential_coordinates(const OneRings& rings, const Positions& positions) {
  Positions W(positions.rows(), 3);
  for (int i = 0; i < positions.rows(); ++i) {
    const auto v = static_cast<std::size_t>(i);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      sum += positions.row(i) - positions.row(rings.neighbours[static_cast<std::size_t>(n)]);
    }
    W.row(i) = sum / rings.degree(i);
  }
  return W;
}

Eigen::SparseMatrix<double> symmetric_laplacian(const OneRings& rings) {
  const auto vertex_count = static_cast<Eigen::Index>(rings.offsets.size()) - 1;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(rings.neighbours.size() + rings.offsets.size());
  for (int i = 0; i < vertex_count; ++i) {
    const auto v = static_cast<std::size_t>(i);
    entries.emplace_back(i, i, rings.degree(i));
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      entries.emplace_back(i, rings.neighbours[static_cast<std::size_t>(n)], -1.0);
    }
  }
  Eigen::SparseMatrix<double> K_L(vertex_count, vertex_count);
  K_L.setFromTriplets(entries.begin(), entries.end());
  return K_L;
}

Positions blend_edge_differences(const OneRings& rings, const std::vector<Positions>& geometries,
                                 const Eigen::MatrixXd& weights) {
  const Eigen::Index count = geometries.front().rows();
  const Eigen::Index stride = weights.cols() > count ? count : 0;
  const auto shares_at = [&](std::size_t s, Eigen::Index i) {
    const auto T = weights.row(static_cast<Eigen::Index>(s));
    return Eigen::RowVector3d(T(i), T(i + stride), T(i + 2 * stride));
  };
  Positions b(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {  // all sources while a vertex's neighbours are at hand
    const auto v = static_cast<std::size_t>(i);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::size_t s = 0; s < geometries.size(); ++s) {
      const Positions& V = geometries[s];
      const Eigen::RowVector3d T_i = shares_at(s, i), V_i = V.row(i);
      for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
        const int j = rings.neighbours[static_cast<std::size_t>(n)];
        const Eigen::RowVector3d T_ij = (T_i + shares_at(s, j)) / 2;
        sum += T_ij.cwiseProduct(V_i - V.row(j));
      }
    }
    b.row(i) = sum;
  }
  return b;
}

Positions blend_vertex_differences(const OneRings& rings, const std::vector<Positions>& geometries,
                                   const Eigen::MatrixXd& weights) {
  const Eigen::Index count = geometries.front().rows();
  const Eigen::Index stride = weights.cols() > count ? count : 0;
  Positions b = Positions::Zero(count, 3);
  for (std::size_t s = 0; s < geometries.size(); ++s) {
    const Positions W = differential_coordinates(rings, geometries[s]);
    const Eigen::RowVectorXd T = weights.row(static_cast<Eigen::Index>(s));
    for (int i = 0; i < b.rows(); ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        b(i, axis) += rings.degree(i) * T(i + axis * stride) * W(i, axis);
      }
    }
  }
  return b;
}

}  // namespace morphbake
