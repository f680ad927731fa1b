#pragma once

#include <string>
#include <vector>

#include "morphbake/correspondence/sphere_layout.h"

namespace morphbake {

/// How landmarks fit after the best rotation: root mean square of their distances, radians.
struct RotationFit {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double residual = 0;
};

/// The rotation (of a disk: about the poles) that takes the landmarks of `layout` closest to those
/// of `reference`; with `mirrored` the best rotation after a reflection.
///
/// @see Kabsch 1976
RotationFit fit_rotation(const SphereLayout& layout, const SphereLayout& reference, bool mirrored);

/// Turns all layouts to the first and draws equal landmarks to one place on the sphere each, where
/// they are pinned exactly.
///
/// @param layouts  of some hundred vertices each
/// @throws         Cancelled
/// @return         indices of landmarks that could not be brought there in some layout: they
///                 contradict the others
std::vector<int> pin_landmarks(std::vector<SphereLayout>& layouts, const Observer& observer = {});

}  // namespace morphbake
