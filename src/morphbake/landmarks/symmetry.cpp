#include "morphbake/landmarks/symmetry.h"

#include <algorithm>
#include <utility>

#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

constexpr int kSamples = 500;
constexpr double kExact = 0.006;   // mean distance to the mirror image, of the diagonal
constexpr double kNoise = 0.001;   // of the diagonal: what samples of a ball differ by
constexpr double kSameTip = 0.04;  // of the diagonal
constexpr double kBranch = 0.35;   // in `reach`: how near a finger is to the tip of the hand
constexpr double kBranchProminence = 0.25;  // of that tip
constexpr double kPaired = 0.12;            // mean cost of tips that pair up in a crooked pose

/// Mean distance between a surface and its image across a plane.
double mirror_distance(const ShapeSketch& shape, const Symmetry& plane) {
  const Positions& positions = shape.mesh.positions;
  const Eigen::Index step = std::max<Eigen::Index>(1, positions.rows() / kSamples);
  Positions images((positions.rows() + step - 1) / step, 3);
  for (Eigen::Index i = 0; i < images.rows(); ++i) {
    images.row(i) = plane.across(positions.row(i * step)).transpose();
  }
  const std::vector<SurfacePoint> closest = closest_points(shape.mesh, images);
  double sum = 0;
  for (Eigen::Index i = 0; i < images.rows(); ++i) {
    const Eigen::Vector3d found = position_of(shape.mesh, closest[static_cast<std::size_t>(i)]);
    sum += (images.row(i).transpose() - found).norm();
  }
  return sum / static_cast<double>(images.rows());
}

/// The plane across an axis of a frame, its normal towards +X (or +Y, +Z where it has no X).
Symmetry plane_across(const Frame& frame, int axis) {
  Symmetry plane;
  plane.sideways = frame.axes.col(axis);
  Eigen::Index largest = 0;
  plane.sideways.cwiseAbs().maxCoeff(&largest);
  if (plane.sideways(largest) < 0) plane.sideways *= -1;
  plane.offset = plane.sideways.dot(frame.centre);
  return plane;
}

/// The tips across an exact plane.
std::vector<int> tips_across(const ShapeSketch& shape, const Symmetry& plane, double diagonal) {
  const auto position = [&](std::size_t tip) -> Eigen::Vector3d {
    return shape.mesh.positions.row(shape.tips[tip].vertex);
  };
  std::vector<int> mirrored(shape.tips.size(), -1);
  for (std::size_t i = 0; i < mirrored.size(); ++i) {
    double nearest = kSameTip * diagonal;
    for (std::size_t j = 0; j < mirrored.size(); ++j) {
      const double apart = (plane.across(position(i)) - position(j)).norm();
      if (apart >= nearest) continue;
      nearest = apart;
      mirrored[i] = static_cast<int>(j);
    }
  }
  return mirrored;
}

/// Keeps what is mutual.
void keep_mutual(std::vector<int>& mirrored) {
  const std::vector<int> all = mirrored;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] >= 0 && all[static_cast<std::size_t>(all[i])] != static_cast<int>(i)) {
      mirrored[i] = -1;
    }
  }
}

bool has_pair(const std::vector<int>& mirrored) {
  for (std::size_t i = 0; i < mirrored.size(); ++i) {
    if (mirrored[i] >= 0 && mirrored[i] != static_cast<int>(i)) return true;
  }
  return false;
}

/// Pairs of tips of a crooked pose: the shape, aligned with itself in a mirror.
Symmetry crooked_symmetry(const ShapeSketch& shape, const std::vector<Frame>& frames) {
  Symmetry best;
  double least = kPaired;
  for (const Frame& frame : frames) {
    for (int axis = 0; axis < 3; ++axis) {
      Frame image = frame;
      image.axes.col(axis) *= -1;
      Alignment alignment = align_in(shape, shape, frame, image);
      keep_mutual(alignment.partner);
      if (alignment.cost >= least || !has_pair(alignment.partner)) continue;
      least = alignment.cost;
      best = plane_across(frame, axis);
      best.found = true;
      best.mirrored = std::move(alignment.partner);
    }
  }
  return best;
}

}  // namespace

Symmetry find_symmetry(const ShapeSketch& shape) {
  const std::vector<Frame> frames = {frame_along(shape.mesh, Eigen::Matrix3d::Identity()),
                                     frame_along(shape.mesh, principal_axes(shape.mesh))};
  const double diagonal = bounding_diagonal(shape.mesh.positions);
  Symmetry best;
  double least = kExact * diagonal;
  for (const Frame& frame : frames) {
    for (int axis = 0; axis < 3; ++axis) {
      Symmetry plane = plane_across(frame, axis);
      // Of shapes with several planes, such as a ball, the first in this order is the one.
      const double distance = mirror_distance(shape, plane);
      const bool is_better =
          best.found ? distance < 0.5 * least - kNoise * diagonal : distance < least;
      if (!is_better) continue;
      least = distance;
      plane.found = plane.is_exact = true;
      best = std::move(plane);
    }
  }
  if (best.found) {
    best.mirrored = tips_across(shape, best, diagonal);
    keep_mutual(best.mirrored);
    return best;
  }
  best = crooked_symmetry(shape, frames);
  if (!best.found) best.mirrored.assign(shape.tips.size(), -1);
  return best;
}

void drop_branches(ShapeSketch& shape) {
  const Symmetry symmetry = find_symmetry(shape);
  const ShapeSketch all = shape;
  shape.tips.clear();
  shape.from_tip.clear();
  for (std::size_t i = 0; i < all.tips.size(); ++i) {
    const Tip& tip = all.tips[i];
    bool is_branch = false;
    for (std::size_t j = 0; j < i; ++j) {
      is_branch = is_branch || (symmetry.mirrored[i] != static_cast<int>(j) &&
                                all.from_tip[j](tip.vertex) < kBranch &&
                                tip.prominence < kBranchProminence * all.tips[j].prominence);
    }
    if (is_branch) continue;
    shape.tips.push_back(tip);
    shape.from_tip.push_back(all.from_tip[i]);
  }
}

void respect_symmetry(const Symmetry& a, const Symmetry& b, std::vector<int>& partner) {
  if (!a.found || !b.found) return;
  for (std::size_t i = 0; i < partner.size(); ++i) {
    const int across = a.mirrored[i];
    if (partner[i] < 0 || across < 0) continue;
    const int expected = b.mirrored[static_cast<std::size_t>(partner[i])];
    int& other = partner[static_cast<std::size_t>(across)];
    if (expected < 0 || other == expected) continue;
    // The one across has no partner or a wrong one: it gets the right one if that is free.
    const bool is_free = std::find(partner.begin(), partner.end(), expected) == partner.end();
    other = is_free && across != static_cast<int>(i) ? expected : -1;
    if (other < 0) partner[i] = -1;
  }
}

}  // namespace morphbake
