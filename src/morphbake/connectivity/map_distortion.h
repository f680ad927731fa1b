#pragma once

#include <string>
#include <vector>

#include "morphbake/connectivity/shared_triangulation.h"

namespace morphbake {

/// Symmetric Dirichlet energy / 4 of the map between equal triangles of two geometries, each scaled
/// to area 1: (s^2 + t^2 + 1/s^2 + 1/t^2) / 4 for singular values s, t.
///
/// @return  #F, 1 (an isometry) to 1e12 (also for triangles without area)
/// @see     Smith and Schaefer 2015
Eigen::VectorXd map_distortion(const Positions& from, const Positions& to,
                               const Triangles& triangles);

/// The distortion of the map from the first source to another, weighted by area of the first.
struct MapQuality {
  std::string source;  ///< the other
  double mean = 1;
  double median = 1;
  double percentile_95 = 1;
  double percentile_99 = 1;
  double maximum = 1;
};

MapQuality summarize_distortion(const Eigen::VectorXd& distortion, const Eigen::VectorXd& areas);

/// Distortion from which a region is worth a look.
constexpr double kHighDistortion = 5;

/// A connected set of triangles with a distortion above kHighDistortion.
struct DistortionRegion {
  std::string source;  ///< the other
  int triangles = 0;
  double area_share = 0;                                   ///< of the first source's area, 0 to 1
  double other_area_share = 0;                             ///< of the other's
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();  ///< on the first source, scene units
  std::string nearest_landmark;                            ///< "" without landmarks
  double landmark_distance = 0;  ///< of `centre` from it, fraction of the diagonal
  bool ends_on_other = false;    ///< whether `end` is on the other source, else on the first
  Eigen::RowVector3d end = Eigen::RowVector3d::Zero();  ///< its point furthest from that landmark,
                                                        ///< on the source where that is further
  double end_distance = 0;  ///< of `end` from it, fraction of that source's diagonal
};

/// The regions of high distortion between the first source and source `other`, largest area first.
///
/// @param names  of the landmarks
std::vector<DistortionRegion> find_distortion_regions(const SharedTriangulation& triangulation,
                                                      std::size_t other,
                                                      const std::vector<std::string>& names);

}  // namespace morphbake
