#include "morphbake/lint/motion_facts.h"

#include <algorithm>
#include <cmath>

namespace morphbake {
namespace {

constexpr int kBetweenKeys = 8;         // of splines
constexpr double kMostDisplaced = 2e9;  // vertices: some seconds
constexpr double kPose = 1000;          // vertices that could be displaced while a pose is set up

/// Whether targets are active at a key or on the way to the next one.
int active_from(const AnimationCurve& curve, Eigen::Index key) {
  const bool is_last = key + 1 == curve.values.rows();
  const bool stays = is_last || curve.interpolation == Interpolation::Step;
  int count = 0;
  for (Eigen::Index t = 0; t < curve.values.cols(); ++t) {
    bool is_active = curve.values(key, t) != 0;
    if (!stays) is_active = is_active || curve.values(key + 1, t) != 0;
    if (!stays && curve.interpolation == Interpolation::CubicSpline) {
      is_active =
          is_active || curve.out_tangents(key, t) != 0 || curve.in_tangents(key + 1, t) != 0;
    }
    count += is_active ? 1 : 0;
  }
  return count;
}

/// The moments at which a curve is looked at.
std::vector<double> moments_of(const AnimationCurve& curve) {
  std::vector<double> moments(curve.times.begin(), curve.times.end());
  if (moments.empty()) return {0};
  if (curve.interpolation != Interpolation::CubicSpline) return moments;
  for (std::size_t k = 0; k + 1 < curve.times.size(); ++k) {
    const double begin = curve.times[k], span = curve.times[k + 1] - begin;
    for (int i = 1; i < kBetweenKeys; ++i) moments.push_back(begin + span * i / kBetweenKeys);
  }
  std::ranges::sort(moments);
  return moments;
}

Float3s posed(const AnimatedPrimitive& primitive, const Eigen::VectorXd& weights) {
  Float3s positions = primitive.positions;
  for (std::size_t t = 0; t < primitive.target_positions.size(); ++t) {
    const auto weight = static_cast<float>(weights(static_cast<Eigen::Index>(t)));
    const Float3s& displacement = primitive.target_positions[t];
    if (weight != 0 && displacement.rows() > 0) positions += weight * displacement;
  }
  return positions;
}

void extend_by_pose(const AnimatedMesh& mesh, const Eigen::VectorXd& weights,
                    Eigen::AlignedBox3d& box) {
  const Eigen::Matrix3d linear = mesh.to_scene.topLeftCorner<3, 3>();
  const Eigen::Vector3d offset = mesh.to_scene.topRightCorner<3, 1>();
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    if (primitive.positions.rows() == 0) continue;
    const Float3s positions = posed(primitive, weights);
    const Eigen::Matrix<double, Eigen::Dynamic, 3> placed =
        positions.cast<double>() * linear.transpose();
    box.extend(Eigen::Vector3d(placed.colwise().minCoeff().transpose()) + offset);
    box.extend(Eigen::Vector3d(placed.colwise().maxCoeff().transpose()) + offset);
  }
}

/// How many targets a pose adds, on average.
double mean_active(const AnimationCurve& curve) {
  const auto active = static_cast<double>((curve.values.array() != 0).count());
  return 1 + active / static_cast<double>(std::max<Eigen::Index>(1, curve.values.rows()));
}

}  // namespace

void find_active(const MeshSurvey& survey, LintedMesh& facts) {
  for (const WeightsChannel& channel : survey.channels) {
    for (Eigen::Index key = 0; key < channel.curve.values.rows(); ++key) {
      const int active = active_from(channel.curve, key);
      if (active <= facts.most_active) continue;
      facts.most_active = active;
      facts.most_active_time = channel.curve.times[static_cast<std::size_t>(key)];
    }
  }
  if (!survey.channels.empty()) return;
  facts.most_active = static_cast<int>((survey.mesh.weights.values.array() != 0).count());
}

void find_bounds(const MeshSurvey& survey, LintedMesh& facts, const Observer& observer) {
  const Eigen::VectorXd zeros = Eigen::VectorXd::Zero(facts.targets);
  extend_by_pose(survey.mesh, zeros, facts.rest);
  if (facts.targets == 0) {
    facts.motion = facts.rest;
    facts.motion_poses = 1;
    return;
  }
  std::vector<const AnimationCurve*> curves;
  for (const WeightsChannel& channel : survey.channels) curves.push_back(&channel.curve);
  if (curves.empty()) curves.push_back(&survey.mesh.weights);
  const double share = kMostDisplaced / static_cast<double>(curves.size());
  for (const AnimationCurve* curve : curves) {
    const std::vector<double> moments = moments_of(*curve);
    const double of_pose = static_cast<double>(facts.vertices) * mean_active(*curve) + kPose;
    const double asked = of_pose * static_cast<double>(moments.size());
    const auto step = static_cast<std::size_t>(std::max(1.0, std::ceil(asked / share)));
    facts.is_motion_sampled = facts.is_motion_sampled || step > 1;
    for (std::size_t m = 0; m < moments.size(); m += step) {
      stop_if_cancelled(observer);
      extend_by_pose(survey.mesh, value_at(*curve, moments[m]), facts.motion);
      ++facts.motion_poses;
    }
  }
}

}  // namespace morphbake
