#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/preview/motion.h"
#include "morphbake/preview/turntable.h"

namespace morphbake {

/// A still camera. Pictures run from -half_width to half_width along `right`, and alike along `up`,
/// at distance 1 along `forward`, moved by `shift`.
struct Camera {
  Eigen::Vector3f position = {0, 0, 1};
  Eigen::Vector3f right = {1, 0, 0};
  Eigen::Vector3f up = {0, 1, 0};
  Eigen::Vector3f forward = {0, 0, -1};
  float half_width = 1;
  float half_height = 1;
  Eigen::Vector2f shift = {0, 0};
};

/// Direction (not of unit length) through a place in the picture, 0, 0 (top left) to 1, 1.
Eigen::Vector3f view_direction(const Camera& camera, float x, float y);

/// The camera and where the subject stands, chosen once for a whole loop.
///
/// In the studio the camera, the lights and the backdrop stand still and the subject turns: the
/// same pictures as from an orbiting camera that carries its lights along.
struct Framing {
  Camera camera;
  /// Mesh space to the studio at azimuth 0; the whole motion fits in the unit sphere.
  Eigen::Affine3d mesh_to_table = Eigen::Affine3d::Identity();
  std::vector<float> floors;  ///< one a moment: height of the floor in the studio
};

/// Mesh space to the studio when the camera is at `azimuth` (radians).
Eigen::Affine3d mesh_to_studio(const Framing& framing, double azimuth);

/// Finds the nearest camera distance at which no moment's larger side exceeds `options.fill` of the
/// picture and no moment comes near its border.
///
/// @throws BakeError "preview.not-finite"
/// @cost   two poses a moment, on all threads of the current task arena
Framing frame_motion(const AnimatedMesh& mesh, const std::vector<LoopMoment>& moments,
                     const TurntableOptions& options);

/// One of several meshes that are shown beside one another.
struct FramedMotion {
  std::string file;  ///< for messages
  const AnimatedMesh& mesh;
  const std::vector<LoopMoment>& moments;
};

/// As frame_motion, of several meshes with one camera and one scale: the same place in all pictures
/// is the same place in space.
///
/// Meshes may lie anywhere in their scenes. Each is moved, once, so that the bounds of its first
/// moment have their middle over one point of one ground; what begins alike is compared where it
/// is.
/// @return  one a motion, with equal cameras
/// @throws BakeError "preview.not-finite", with the file
std::vector<Framing> frame_side_by_side(const std::vector<FramedMotion>& motions,
                                        const TurntableOptions& options);

}  // namespace morphbake
