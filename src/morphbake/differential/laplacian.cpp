#include "morphbake/differential/laplacian.h"

#include <span>

namespace morphbake {
namespace {

std::span<const int> neighbours_of(const OneRings& rings, Eigen::Index i) {
  const auto v = static_cast<std::size_t>(i);
  const std::span<const int> all = rings.neighbours;
  return all.subspan(static_cast<std::size_t>(rings.offsets[v]),
                     static_cast<std::size_t>(rings.degree(static_cast<int>(i))));
}

}  // namespace

std::vector<Eigen::Index> sources_with_weights(const Eigen::MatrixXd& weights) {
  std::vector<Eigen::Index> sources;
  for (Eigen::Index s = 0; s < weights.rows(); ++s) {
    if (!weights.row(s).isZero(0)) sources.push_back(s);
  }
  return sources;
}

Positions differential_coordinates(const OneRings& rings, const Positions& positions) {
  Positions W(positions.rows(), 3);
  for (int i = 0; i < positions.rows(); ++i) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const int j : neighbours_of(rings, i)) sum += positions.row(i) - positions.row(j);
    W.row(i) = sum / rings.degree(i);
  }
  return W;
}

Eigen::SparseMatrix<double> symmetric_laplacian(const OneRings& rings) {
  const auto vertex_count = static_cast<Eigen::Index>(rings.offsets.size()) - 1;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(rings.neighbours.size() + rings.offsets.size());
  for (int i = 0; i < vertex_count; ++i) {
    entries.emplace_back(i, i, rings.degree(i));
    for (const int j : neighbours_of(rings, i)) entries.emplace_back(i, j, -1.0);
  }
  Eigen::SparseMatrix<double> K_L(vertex_count, vertex_count);
  K_L.setFromTriplets(entries.begin(), entries.end());
  return K_L;
}

Positions blend_edge_differences(const OneRings& rings, const std::vector<Positions>& geometries,
                                 const Eigen::MatrixXd& weights) {
  const Eigen::Index count = geometries.front().rows();
  const bool is_per_axis = weights.cols() > count;
  const auto mean_shares = [&](Eigen::Index s, Eigen::Index i,
                               Eigen::Index j) -> Eigen::RowVector3d {
    const auto mean = [&](Eigen::Index first) {
      return (weights(s, first + i) + weights(s, first + j)) / 2;
    };
    if (is_per_axis) return {mean(0), mean(count), mean(2 * count)};
    return Eigen::RowVector3d::Constant(mean(0));
  };
  const std::vector<Eigen::Index> sources = sources_with_weights(weights);
  Positions b(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {  // all sources while a vertex's neighbours are at hand
    const std::span<const int> neighbours = neighbours_of(rings, i);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const Eigen::Index s : sources) {
      const Positions& V = geometries[static_cast<std::size_t>(s)];
      const Eigen::RowVector3d V_i = V.row(i);
      for (const int j : neighbours) sum += mean_shares(s, i, j).cwiseProduct(V_i - V.row(j));
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
