#pragma once

#include <Eigen/Core>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Places on a picture: #P by 2, x to the right and y downwards, as glTF's TEXCOORD.
using PicturePlaces = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// A surface cut into charts that lie side by side on a square picture.
///
/// Invariant: a chart is a disk; no two triangles overlap; charts are 2 * padding texels or more
/// from one another and padding from the picture's edge. Seen from outside, no chart is mirrored.
struct Atlas {
  int size = 0;                ///< texels of a side
  int padding = 0;             ///< texels around a chart that are its own
  int chart_count = 0;         ///< charts are numbered by their first triangle
  std::vector<int> chart;      ///< #F
  std::vector<int> of_corner;  ///< 3 #F: corner 3 f + k -> row of `places`
  PicturePlaces places;        ///< #P by 2 in [0, 1]: each vertex once a chart that it is in
  double covered = 0;          ///< share of the square that triangles cover
};

/// How large an atlas is.
struct AtlasOptions {
  int size = 2048;  ///< texels of a side, 64 to 8192

  /// Texels around each chart that repeat its colours, 1 to 64. Mip level n needs 2^n.
  int padding = 4;
};

/// Cuts the surface into charts and lays them on a picture, all at one number of texels a length.
///
/// Triangles are merged to ever larger disks, flat and round ones first, across hard edges last
/// (Garland et al. 2001). Each is flattened by flatten_chart; one that cannot be comes apart into
/// the two disks it was merged of. Charts are packed by their outlines (Lévy et al. 2002).
/// @param mesh        an oriented manifold
/// @param hard_edges  vertices a < b: seams are hidden there
/// @throws BakeError "connectivity.texture-too-small" when not even points of charts find room;
///         Cancelled
/// @cost   O(#F log #F); threads flatten charts; the result does not depend on their number
Atlas make_atlas(const Mesh& mesh, const std::vector<Eigen::Vector2i>& hard_edges,
                 const AtlasOptions& options, const Observer& observer = {});

}  // namespace morphbake
