// SPDX-License-Identifier: GPL-3.0-or-later
#include "variants.h"

#include <cmath>

namespace shapes {
namespace {

Vector stretched(const Stretch& stretch, const Vector& p) {
  return stretch.about + stretch.scale.cwiseProduct(p - stretch.about) + stretch.shift;
}

/// Where one group's stretch takes p; p itself if the group has none.
Vector stretched(const Variant& variant, const std::string& group, const Vector& p) {
  for (const Stretch& stretch : variant.stretches)
    if (stretch.group == group) return stretched(stretch, p);
  return p;
}

/// The mean of where the groups take p, weighted by the nearness of their parts.
Vector followed(const Solid& base, const Variant& variant, const Vector& p) {
  const double reach = 1.8 * base.edge;  // shorter folds the creases, longer blurs the variant
  Vector sum = Vector::Zero();
  double total = 0;
  for (const Part& part : base.parts) {
    const double weight = std::exp(-distance(part.form, p) / reach);
    sum += weight * stretched(variant, part.group, p);
    total += weight;
  }
  return stretched(variant, "", sum / total);
}

}  // namespace

Mesh varied(const Mesh& mesh, const Solid& base, const Variant& variant) {
  Mesh result = mesh;
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v)
    result.positions.row(v) =
        followed(base, variant, mesh.positions.row(v).transpose()).transpose();
  round_to_float(result.positions);
  return result;
}

}  // namespace shapes
