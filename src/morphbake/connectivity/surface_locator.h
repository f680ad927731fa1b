#pragma once

#include <Eigen/Core>
#include <memory>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Finds the closest points of one surface; owns the search tree over its triangles.
class SurfaceLocator {
 public:
  /// @param mesh  must outlive the locator; triangles without area are never found
  explicit SurfaceLocator(const Mesh& mesh);
  ~SurfaceLocator();
  SurfaceLocator(const SurfaceLocator&) = delete;
  SurfaceLocator& operator=(const SurfaceLocator&) = delete;

  /// Closest point; coordinates below 1e-12 become 0, so that points of an edge lie on it exactly.
  SurfacePoint closest(const Eigen::Vector3d& position) const;

  /// Distance to the closest point.
  double distance(const Eigen::Vector3d& position) const;

 private:
  struct Tree;

  const Mesh& mesh_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace morphbake
