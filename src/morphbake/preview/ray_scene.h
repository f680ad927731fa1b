#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/preview/pose.h"

namespace morphbake {

/// Where a ray meets a triangle.
struct RayHit {
  int primitive = 0;
  int triangle = 0;
  float distance = 0;  ///< in lengths of the ray's direction
  /// Of the triangle's three corners, sum 1.
  Eigen::Vector3f barycentric = Eigen::Vector3f::Zero();
  /// By the triangle's winding; its length is twice the triangle's area.
  Eigen::Vector3f face_normal = Eigen::Vector3f::Zero();
};

/// The posed triangles in a form that rays can be traced through; owns the Embree scene.
class RayScene {
 public:
  /// @param mesh   gives the triangles
  /// @param poses  one a primitive, with the final number of vertices; must outlive the scene and
  ///               keep their memory, for it is shared
  RayScene(const AnimatedMesh& mesh, const std::vector<PosedPrimitive>& poses);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Must be called after the poses changed. Keeps the tree, so it costs a tenth of building it.
  void refit();

  /// The nearest triangle along the ray. Safe to call from several threads, as is_occluded.
  std::optional<RayHit> first_hit(const Eigen::Vector3f& origin,
                                  const Eigen::Vector3f& direction) const;

  /// Whether anything lies on the ray at less than `far` lengths of `direction`.
  bool is_occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                   float far) const;

 private:
  /// Whether the ray comes near the subject at all: most rays of a floor do not, and asking here is
  /// much cheaper than entering Embree.
  bool misses_bounds(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  void commit();

  struct Embree;
  std::unique_ptr<Embree> embree_;
  Eigen::Array3f low_ = Eigen::Array3f::Zero();  ///< bounds of the pose, a little enlarged
  Eigen::Array3f high_ = Eigen::Array3f::Zero();
};

}  // namespace morphbake
