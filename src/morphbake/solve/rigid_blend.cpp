#include "morphbake/solve/rigid_blend.h"

#include <utility>

#include "morphbake/differential/rotation_vector.h"

namespace morphbake {
namespace {

/// The rotation that brings `from` nearest to `to`, both about their centres.
Eigen::Quaterniond rotation_between(const Positions& from, const Positions& to) {
  const Eigen::Matrix4d map =
      Eigen::umeyama(Eigen::Matrix3Xd(from.transpose()), Eigen::Matrix3Xd(to.transpose()), false);
  const Eigen::Matrix3d rotation = map.topLeftCorner<3, 3>();
  return Eigen::Quaterniond(rotation).normalized();
}

}  // namespace

RigidBlend::RigidBlend(const MorphableMesh& mesh, Eigen::VectorXd gauge)
    : components_(connected_components(one_rings(mesh.connectivity))), gauge_(std::move(gauge)) {
  std::vector<std::vector<int>> members(static_cast<std::size_t>(components_.count));
  for (std::size_t v = 0; v < components_.label.size(); ++v) {
    members[static_cast<std::size_t>(components_.label[v])].push_back(static_cast<int>(v));
  }
  for (const Positions& source : mesh.geometries) {
    std::vector<Motion> motions;
    Positions aligned = source;
    for (const std::vector<int>& vertices : members) {
      const Positions first = mesh.geometries.front()(vertices, Eigen::all);
      const Positions own = source(vertices, Eigen::all);
      Motion motion;
      motion.centre = own.colwise().mean().transpose();
      const Eigen::Quaterniond rotation = rotation_between(first, own);
      motion.rotation = rotation_vector(rotation);
      aligned(vertices, Eigen::all) =
          (own.rowwise() - own.colwise().mean()) * rotation.toRotationMatrix();
      motions.push_back(motion);
    }
    motions_.push_back(std::move(motions));
    aligned_.push_back(std::move(aligned));
  }
}

Positions RigidBlend::shape(const TransitionState& T) const {
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(T.rows(), components_.count);
  for (Eigen::Index v = 0; v < T.cols(); ++v) {
    means.col(components_.label[static_cast<std::size_t>(v)]) += gauge_(v) * T.col(v);
  }
  std::vector<Eigen::Matrix3d> rotations;
  std::vector<Eigen::Vector3d> centres;
  for (Eigen::Index c = 0; c < means.cols(); ++c) {
    Eigen::Vector3d turn = Eigen::Vector3d::Zero(), centre = turn;
    for (std::size_t s = 0; s < motions_.size(); ++s) {
      const Motion& motion = motions_[s][static_cast<std::size_t>(c)];
      turn += means(static_cast<Eigen::Index>(s), c) * motion.rotation;
      centre += means(static_cast<Eigen::Index>(s), c) * motion.centre;
    }
    rotations.push_back(rotation_of(turn).toRotationMatrix());
    centres.push_back(centre);
  }
  Positions shape(T.cols(), 3);
  for (Eigen::Index v = 0; v < T.cols(); ++v) {
    const auto component = static_cast<std::size_t>(components_.label[static_cast<std::size_t>(v)]);
    Eigen::Vector3d mixed = Eigen::Vector3d::Zero();
    for (std::size_t s = 0; s < aligned_.size(); ++s) {
      mixed += T(static_cast<Eigen::Index>(s), v) * aligned_[s].row(v).transpose();
    }
    shape.row(v) = (rotations[component] * mixed + centres[component]).transpose();
  }
  return shape;
}

}  // namespace morphbake
