#pragma once

#include <Eigen/Core>
#include <memory>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Finds the points of a surface below those of another that lies close to it; owns a search tree.
class FacingPoints {
 public:
  /// @param mesh  with a triangle; must outlive the search
  explicit FacingPoints(const Mesh& mesh);
  ~FacingPoints();
  FacingPoints(const FacingPoints&) = delete;
  FacingPoints& operator=(const FacingPoints&) = delete;

  /// The point that is closest to `position` among the triangles whose normal is less than 90
  /// degrees from `normal`, so that the far side of what is thin is never met.
  ///
  /// Safe to call from several threads. Of equally close points, the one returned may depend on
  /// `near`.
  /// @param near  a point of the surface about there: the answer if no facing one is closer. The
  ///              closer it is, the faster is the search.
  SurfacePoint find(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                    const SurfacePoint& near) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace morphbake
