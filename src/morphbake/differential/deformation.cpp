#include "morphbake/differential/deformation.h"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <cmath>

#include "morphbake/differential/rotation_vector.h"
#include "morphbake/mesh/normals.h"

namespace morphbake {
namespace {

/// Weight of the normal beside the edges, whose squared lengths sum to 1: most one-rings are nearly
/// flat, and say little of what happens across them.
constexpr double kNormalWeight = 0.3;

/// Of the one-ring's size: what flat and slanted one-rings without normals are stretched by is 1.
constexpr double kRegular = 1e-9;

/// Least squares over the one-ring's edges and the normal.
Eigen::Matrix3d gradient_at(const OneRings& rings, int vertex, const Positions& from,
                            const Positions& to, const Normals& from_normals,
                            const Normals& to_normals) {
  const auto v = static_cast<std::size_t>(vertex);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero(), products = squares;
  double from_size = 0, to_size = 0;
  for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
    const int j = rings.neighbours[static_cast<std::size_t>(n)];
    const Eigen::Vector3d p = from.row(j) - from.row(vertex), q = to.row(j) - to.row(vertex);
    squares += p * p.transpose();
    products += q * p.transpose();
    from_size += p.squaredNorm();
    to_size += q.squaredNorm();
  }
  if (!(from_size > 0)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d p = from_normals.row(vertex), q = to_normals.row(vertex);
  const double scale = std::sqrt(to_size / from_size);
  squares += kNormalWeight * from_size * p * p.transpose();
  products += kNormalWeight * from_size * scale * q * p.transpose();
  squares += kRegular * from_size * Eigen::Matrix3d::Identity();
  products += kRegular * from_size * scale * Eigen::Matrix3d::Identity();
  return products * squares.inverse();
}

}  // namespace

std::vector<Edge> edges_of(const OneRings& rings) {
  std::vector<Edge> edges;
  edges.reserve(rings.neighbours.size() / 2);
  for (int a = 0; a + 1 < static_cast<int>(rings.offsets.size()); ++a) {
    const auto v = static_cast<std::size_t>(a);
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      const int b = rings.neighbours[static_cast<std::size_t>(n)];
      if (a < b) edges.push_back({a, b});
    }
  }
  return edges;
}

Deformation deformation_of(const OneRings& rings, const std::vector<Edge>& edges,
                           const Triangles& triangles, const Positions& from, const Positions& to) {
  const Normals from_normals = smooth_normals(from, triangles);
  const Normals to_normals = smooth_normals(to, triangles);
  const auto count = static_cast<std::size_t>(from.rows());
  Deformation deformation;
  deformation.rotations.resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    const auto vertex = static_cast<int>(v);
    deformation.rotations[v] = Eigen::Quaterniond(
        nearest_rotation(gradient_at(rings, vertex, from, to, from_normals, to_normals)));
  });
  deformation.turns.resize(edges.size());
  tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t e) {
    const RotationField& R = deformation.rotations;
    deformation.turns[e] = rotation_vector(R[static_cast<std::size_t>(edges[e].a)].conjugate() *
                                           R[static_cast<std::size_t>(edges[e].b)]);
  });
  return deformation;
}

}  // namespace morphbake
