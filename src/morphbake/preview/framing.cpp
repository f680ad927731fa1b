// The distance follows from the silhouettes of every moment. A vertex at (x, y, z) in view axes is
// seen at x / (d - z), so which vertices bound a silhouette depends on d: those that do at four
// distances around the answer stand for all, and the distance is found by bisection on them alone.
#include "morphbake/preview/framing.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/preview/pose.h"

namespace morphbake {
namespace {

constexpr double kLargestUnion =
    0.94;  ///< share of the picture for all moments together: never cut
constexpr int kBisections = 48;

/// Tangents of view angles.
struct PictureBox {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e30);
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-1e30);

  void extend(const Eigen::Vector2d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

Eigen::Vector2d seen_from(const Eigen::Vector3d& view_point, double distance) {
  return view_point.head<2>() / (distance - view_point.z());
}

Eigen::AlignedBox3d bounds_of(const std::vector<PosedPrimitive>& poses) {
  Eigen::AlignedBox3d bounds;
  for (const PosedPrimitive& pose : poses) {
    const Eigen::Index count = pose.positions.rows() - 1;
    if (count < 1) continue;
    const auto positions = pose.positions.topRows(count);
    bounds.extend(positions.colwise().minCoeff().transpose().cast<double>());
    bounds.extend(positions.colwise().maxCoeff().transpose().cast<double>());
  }
  return bounds;
}

[[noreturn]] void fail_not_finite(const std::string& file, std::size_t moment) {
  Problem problem;
  problem.location.file = file;
  problem.code = "preview.not-finite";
  problem.message = fmt::format("picture {} has a vertex that is infinite or not a number", moment);
  problem.hint = "check the morph targets and weights of the file";
  throw BakeError(std::move(problem));
}

bool all_finite(const std::vector<PosedPrimitive>& poses) {
  return std::all_of(poses.begin(), poses.end(),
                     [](const PosedPrimitive& pose) { return pose.positions.allFinite(); });
}

/// Turns and scales into the scene but does not move: the place is taken away anyway, and a far one
/// would cost all of float's digits.
Eigen::Affine3d to_scene_axes(const AnimatedMesh& mesh) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.linear() = mesh.to_scene.topLeftCorner<3, 3>();
  return transform;
}

/// Bounds of every moment, as to_scene_axes.
std::vector<Eigen::AlignedBox3d> moment_bounds(const FramedMotion& motion) {
  const AnimatedMesh& mesh = motion.mesh;
  const std::vector<LoopMoment>& moments = motion.moments;
  std::vector<Eigen::AlignedBox3d> bounds(moments.size());
  std::vector<char> finite(moments.size());
  const Eigen::Affine3d to_scene = to_scene_axes(mesh);
  tbb::parallel_for(std::size_t{0}, moments.size(), [&](std::size_t i) {
    std::vector<PosedPrimitive> poses;
    pose_mesh(mesh, moments[i].weights, to_scene, poses);
    finite[i] = all_finite(poses) ? 1 : 0;
    bounds[i] = bounds_of(poses);
  });
  const auto bad = std::find(finite.begin(), finite.end(), 0);
  if (bad != finite.end())
    fail_not_finite(motion.file, static_cast<std::size_t>(bad - finite.begin()));
  return bounds;
}

/// Moves the middle of the whole motion to the origin and scales it into the unit sphere.
///
/// @param shift  was already added to `all`
Eigen::Affine3d table_transform(const AnimatedMesh& mesh, const Eigen::Vector3d& shift,
                                const Eigen::AlignedBox3d& all) {
  if (all.isEmpty()) return to_scene_axes(mesh);
  const double radius = all.diagonal().norm() / 2;
  const double scale = radius > 0 ? 1 / radius : 1;
  return Eigen::Scaling(scale) * Eigen::Translation3d(shift - all.center()) * to_scene_axes(mesh);
}

/// Moves the middle of a box's lower side to the origin.
Eigen::Vector3d shift_to_ground(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  return {-box.center().x(), -box.min().y(), -box.center().z()};
}

using Silhouette = std::vector<Eigen::Vector3d>;  ///< view axes: right, up, towards the camera

/// The points that reach furthest to the four sides of a picture.
struct Extremes {
  std::array<Eigen::Vector3d, 4> points{};
  std::array<double, 4> reach{-1e30, -1e30, -1e30, -1e30};

  void add(const Eigen::Vector3d& point, const Eigen::Vector2d& seen) {
    const std::array<double, 4> sides{-seen.x(), seen.x(), -seen.y(), seen.y()};
    for (std::size_t side = 0; side < 4; ++side) {
      if (sides[side] <= reach[side]) continue;
      reach[side] = sides[side];
      points[side] = point;
    }
  }
};

/// The vertices that bound the picture at one of `distances`, four a distance.
Silhouette silhouette_of(const std::vector<PosedPrimitive>& poses, const Eigen::Matrix3d& view,
                         const std::array<double, 4>& distances) {
  std::array<Extremes, 4> extremes;
  bool is_empty = true;
  for (const PosedPrimitive& pose : poses) {
    for (Eigen::Index v = 0; v + 1 < pose.positions.rows(); ++v) {
      const Eigen::Vector3d point = view * pose.positions.row(v).transpose().cast<double>();
      is_empty = false;
      for (std::size_t d = 0; d < distances.size(); ++d) {
        extremes[d].add(point, seen_from(point, distances[d]));
      }
    }
  }
  Silhouette silhouette;
  if (is_empty) return silhouette;
  for (const Extremes& each : extremes) {
    silhouette.insert(silhouette.end(), each.points.begin(), each.points.end());
  }
  return silhouette;
}

/// How large the subject is in the picture, as shares of its sides.
struct Coverage {
  double largest_side = 0;  ///< of any moment
  double all_sides = 0;     ///< of all moments together
  PictureBox all;
};

Coverage coverage_at(const std::vector<Silhouette>& silhouettes, double distance,
                     const Eigen::Vector2d& picture) {
  Coverage coverage;
  for (const Silhouette& silhouette : silhouettes) {
    PictureBox box;
    for (const Eigen::Vector3d& point : silhouette) box.extend(seen_from(point, distance));
    if (silhouette.empty()) continue;
    coverage.largest_side =
        std::max(coverage.largest_side, (box.high - box.low).cwiseQuotient(picture).maxCoeff());
    coverage.all.extend(box.low);
    coverage.all.extend(box.high);
  }
  coverage.all_sides = (coverage.all.high - coverage.all.low).cwiseQuotient(picture).maxCoeff();
  return coverage;
}

/// Bisection between the unit sphere's surface and a distance from which it is a speck.
double fitting_distance(const std::vector<Silhouette>& silhouettes, const Eigen::Vector2d& picture,
                        double fill) {
  double near = 1.05;
  double far = 100 / picture.minCoeff();
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (near + far) / 2;
    const Coverage coverage = coverage_at(silhouettes, middle, picture);
    const bool fits = coverage.largest_side <= fill && coverage.all_sides <= kLargestUnion;
    (fits ? far : near) = middle;
  }
  return far;
}

/// Rows: right, up, towards the camera.
Eigen::Matrix3d view_axes(double elevation) {
  const double e = elevation * std::numbers::pi / 180;
  Eigen::Matrix3d view;
  view << 1, 0, 0, 0, std::cos(e), -std::sin(e), 0, std::sin(e), std::cos(e);
  return view;
}

std::vector<Silhouette> silhouettes_of(const FramedMotion& motion, const Framing& framing,
                                       const Eigen::Matrix3d& view, double half_height) {
  const std::vector<LoopMoment>& moments = motion.moments;
  const double typical = 1 / half_height;
  const std::array<double, 4> distances{std::max(1.05, 0.8 * typical), std::max(1.1, typical),
                                        std::max(1.2, 1.3 * typical), std::max(1.5, 1.8 * typical)};
  std::vector<Silhouette> silhouettes(moments.size());
  tbb::parallel_for(std::size_t{0}, moments.size(), [&](std::size_t i) {
    std::vector<PosedPrimitive> poses;
    pose_mesh(motion.mesh, moments[i].weights, mesh_to_studio(framing, moments[i].azimuth), poses);
    silhouettes[i] = silhouette_of(poses, view, distances);
  });
  return silhouettes;
}

std::vector<float> floor_heights(const std::vector<Eigen::AlignedBox3d>& bounds,
                                 const Eigen::AlignedBox3d& all, bool follows) {
  const double radius = all.isEmpty() ? 0 : all.diagonal().norm() / 2;
  std::vector<float> floors(bounds.size(), 0.0f);
  if (!(radius > 0)) return floors;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double lowest = follows && !bounds[i].isEmpty() ? bounds[i].min().y() : all.min().y();
    floors[i] = static_cast<float>((lowest - all.center().y()) / radius);
  }
  return floors;
}

/// The camera whose pictures all silhouettes fill and fit into.
Camera camera_for(const std::vector<Silhouette>& silhouettes, bool has_extent,
                  const Eigen::Matrix3d& view, const Eigen::Vector2d& picture, double fill) {
  const double distance = has_extent ? fitting_distance(silhouettes, picture, fill) : 5.0;
  Camera camera;
  camera.position = (view.row(2).transpose() * distance).cast<float>();
  camera.right = view.row(0).transpose().cast<float>();
  camera.up = view.row(1).transpose().cast<float>();
  camera.forward = -view.row(2).transpose().cast<float>();
  camera.half_width = static_cast<float>(picture.x() / 2);
  camera.half_height = static_cast<float>(picture.y() / 2);
  if (has_extent) {
    const Coverage coverage = coverage_at(silhouettes, distance, picture);
    camera.shift = ((coverage.all.low + coverage.all.high) / 2).cast<float>();
  }
  return camera;
}

/// A motion and the box of each of its moments, moved by `shift` from the scene's axes.
struct PlacedMotion {
  const FramedMotion& motion;
  Eigen::Vector3d shift;
  std::vector<Eigen::AlignedBox3d> bounds;
};

std::vector<Framing> frame_placed(const std::vector<PlacedMotion>& placed,
                                  const TurntableOptions& options) {
  Eigen::AlignedBox3d all;
  for (const PlacedMotion& each : placed) {
    for (const Eigen::AlignedBox3d& box : each.bounds) all.extend(box);
  }
  const Eigen::Matrix3d view = view_axes(options.elevation);
  const double half_height = std::tan(options.field_of_view * std::numbers::pi / 360);
  const double half_width = half_height * options.width / options.height;
  std::vector<Framing> framings;
  std::vector<Silhouette> silhouettes;
  for (const PlacedMotion& each : placed) {
    Framing& framing = framings.emplace_back();
    framing.mesh_to_table = table_transform(each.motion.mesh, each.shift, all);
    framing.floors = floor_heights(each.bounds, all, options.floor_follows);
    for (Silhouette& silhouette : silhouettes_of(each.motion, framing, view, half_height)) {
      silhouettes.push_back(std::move(silhouette));
    }
  }
  const bool has_extent = all.isEmpty() ? false : all.diagonal().norm() > 0;
  const Camera camera =
      camera_for(silhouettes, has_extent, view, {2 * half_width, 2 * half_height}, options.fill);
  for (Framing& framing : framings) framing.camera = camera;
  return framings;
}

}  // namespace

Eigen::Vector3f view_direction(const Camera& camera, float x, float y) {
  const float across = (2 * x - 1) * camera.half_width + camera.shift.x();
  const float upward = (1 - 2 * y) * camera.half_height + camera.shift.y();
  return camera.forward + across * camera.right + upward * camera.up;
}

Eigen::Affine3d mesh_to_studio(const Framing& framing, double azimuth) {
  return Eigen::AngleAxisd(-azimuth, Eigen::Vector3d::UnitY()) * framing.mesh_to_table;
}

Framing frame_motion(const AnimatedMesh& mesh, const std::vector<LoopMoment>& moments,
                     const TurntableOptions& options) {
  const FramedMotion motion{{}, mesh, moments};
  return frame_placed({{motion, Eigen::Vector3d::Zero(), moment_bounds(motion)}}, options).front();
}

std::vector<Framing> frame_side_by_side(const std::vector<FramedMotion>& motions,
                                        const TurntableOptions& options) {
  std::vector<PlacedMotion> placed;
  for (const FramedMotion& motion : motions) {
    std::vector<Eigen::AlignedBox3d> bounds = moment_bounds(motion);
    const Eigen::Vector3d shift = shift_to_ground(bounds.front());
    for (Eigen::AlignedBox3d& box : bounds) box.translate(shift);
    placed.push_back({motion, shift, std::move(bounds)});
  }
  return frame_placed(placed, options);
}

}  // namespace morphbake
