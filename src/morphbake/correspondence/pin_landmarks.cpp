#include "morphbake/correspondence/pin_landmarks.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace morphbake {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kSweeps = 400;
constexpr double kNear = 0.02;     // radians: from here a landmark may jump to its target
constexpr double kJumpEnergy = 3;  // times the star's energy, which a jump may cost
constexpr int kLateSweep = 300;    // from here any jump will do that turns no triangle
constexpr double kLateJumpEnergy = 1e12;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

const Vector3d& landmark_of(const SphereLayout& layout, std::size_t l) {
  return layout.sphere[index(layout.surface->landmarks[l])];
}

/// Rotation about the z axis that takes `from` closest to `to`.
Matrix3d polar_rotation(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) {
  double sine = 0, cosine = 0;
  for (std::size_t l = 0; l < from.size(); ++l) {
    sine += from[l].x() * to[l].y() - from[l].y() * to[l].x();
    cosine += from[l].x() * to[l].x() + from[l].y() * to[l].y();
  }
  return Eigen::AngleAxisd(std::atan2(sine, cosine), Vector3d::UnitZ()).toRotationMatrix();
}

Matrix3d free_rotation(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) {
  Matrix3d covariance = Matrix3d::Zero();
  for (std::size_t l = 0; l < from.size(); ++l) covariance += to[l] * from[l].transpose();
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d signs = Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// Draws the landmarks of one layout to their targets.
///
/// @return  those that did not arrive
std::vector<int> draw_to_targets(SphereLayout& layout, const std::vector<Vector3d>& targets,
                                 const Observer& observer) {
  const std::vector<int>& landmarks = layout.surface->landmarks;
  layout.targets.assign(layout.sphere.size(), Vector3d::Zero());
  for (std::size_t l = 0; l < landmarks.size(); ++l) {
    layout.targets[index(landmarks[l])] = targets[l];
  }
  std::size_t missing = landmarks.size();
  double pull = 1;
  for (int sweep = 0; sweep < kSweeps && missing > 0; ++sweep) {
    layout.pull = pull;
    relax(layout, 1, observer);
    pull = std::min(1e5, 1.1 * pull);
    layout.pull = 0;  // jumps are judged by shape alone
    for (std::size_t l = 0; l < landmarks.size(); ++l) {
      const int v = landmarks[l];
      if (layout.pinned[index(v)]) continue;
      const bool is_late = sweep > kLateSweep;
      if (!is_late && (layout.sphere[index(v)] - targets[l]).norm() > kNear) continue;
      const double energy = star_energy(layout, v, targets[l]);
      const double bound =
          is_late ? kLateJumpEnergy : kJumpEnergy * star_energy(layout, v, layout.sphere[index(v)]);
      if (!(energy < bound)) continue;
      layout.sphere[index(v)] = targets[l];
      layout.pinned[index(v)] = 1;
      --missing;
    }
  }
  layout.targets.clear();
  std::vector<int> unpinned;
  for (std::size_t l = 0; l < landmarks.size(); ++l) {
    if (!layout.pinned[index(landmarks[l])]) unpinned.push_back(static_cast<int>(l));
  }
  return unpinned;
}

}  // namespace

RotationFit fit_rotation(const SphereLayout& layout, const SphereLayout& reference, bool mirrored) {
  std::vector<Vector3d> from, to;
  for (std::size_t l = 0; l < layout.surface->landmarks.size(); ++l) {
    from.push_back(landmark_of(layout, l));
    if (mirrored) from.back().x() = -from.back().x();
    to.push_back(landmark_of(reference, l));
  }
  RotationFit fit;
  fit.rotation = layout.surface->apex < 0 ? free_rotation(from, to) : polar_rotation(from, to);
  for (std::size_t l = 0; l < from.size(); ++l) {
    const double angle = std::acos(std::clamp(to[l].dot(fit.rotation * from[l]), -1.0, 1.0));
    fit.residual += angle * angle / static_cast<double>(from.size());
  }
  fit.residual = std::sqrt(fit.residual);
  return fit;
}

std::vector<int> pin_landmarks(std::vector<SphereLayout>& layouts, const Observer& observer) {
  for (std::size_t s = 1; s < layouts.size(); ++s) {
    const Matrix3d rotation = fit_rotation(layouts[s], layouts[0], false).rotation;
    const bool keeps_equator = layouts[s].surface->apex >= 0;
    for (std::size_t v = 0; v < layouts[s].sphere.size(); ++v) {
      Vector3d& place = layouts[s].sphere[v];
      place = rotation * place;
      if (keeps_equator && layouts[s].surface->on_boundary[v]) place.z() = 0;
      if (static_cast<int>(v) == layouts[s].surface->apex) place = -Vector3d::UnitZ();
    }
  }
  std::vector<Vector3d> targets(layouts[0].surface->landmarks.size(), Vector3d::Zero());
  for (std::size_t l = 0; l < targets.size(); ++l) {
    for (const SphereLayout& layout : layouts) targets[l] += landmark_of(layout, l);
    targets[l].normalize();
  }
  std::vector<std::vector<int>> unpinned(layouts.size());
  tbb::parallel_for(std::size_t{0}, layouts.size(), [&](std::size_t s) {
    unpinned[s] = draw_to_targets(layouts[s], targets, observer);
    relax(layouts[s], 40, observer);
  });
  std::vector<int> all;
  for (const std::vector<int>& of_one : unpinned)
    all.insert(all.end(), of_one.begin(), of_one.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace morphbake
