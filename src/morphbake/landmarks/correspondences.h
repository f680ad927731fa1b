#pragma once

#include <optional>
#include <vector>

#include "morphbake/landmarks/alignment.h"
#include "morphbake/landmarks/symmetry.h"
#include "morphbake/transition/surface_distance.h"

namespace morphbake {

/// What a pair of corresponding points is.
enum class PairKind { Tip, Rim, Point };

/// Corresponding vertices of two sketches.
struct VertexPair {
  int a = 0;
  int b = 0;
  PairKind kind = PairKind::Tip;
  int unit = 0;  ///< equal for the two of a mirrored pair
};

/// One of two shapes: its sketch, its sides, distances from its landmarks.
struct Side {
  const ShapeSketch& sketch;
  Frame frame;
  Symmetry symmetry;
  VertexDistances distances;
  std::vector<Eigen::VectorXd> from_landmark;  ///< one a pair: #V, in `reach`
  Normals normals;                             ///< #V

  explicit Side(const ShapeSketch& shape);

  Eigen::Vector3d position(int vertex) const { return sketch.mesh.positions.row(vertex); }

  /// Distance to the nearest landmark, in `reach`; infinity without any.
  double to_landmark(int vertex) const;

  /// The vertex closest to the mirror image of another.
  int across(int vertex) const;

  /// The vertex across of one that is well off the plane of an exact symmetry, else -1.
  int twin(int vertex) const;
};

/// Corresponding points of two shapes as they are found.
struct Correspondences {
  Side a;
  Side b;
  std::vector<VertexPair> pairs;
  int units = 0;
};

/// Adds a pair, of the same unit as the last when it is its mirror image.
void add_pair(Correspondences& all, int a, int b, PairKind kind, bool mirrors_last);

/// Where a point lies on a shape that is its own mirror image: on the plane as a nose, or so far
/// off it that the point across is another one.
enum class Lies { Anywhere, OnPlane, OffPlane };

/// Where a vertex of one shape lies on the other: alike in its distances to the landmarks, above
/// all the near ones, in its place in the box, and in the direction that it faces.
///
/// @param kind  a tip that only `from` has goes to no tip of `to`
/// @param lies  where it shall lie if `to` is its own mirror image
/// @return      nothing when a landmark is there already
std::optional<int> transferred(const Side& from, const Side& to, int vertex, PairKind kind,
                               Lies lies);

/// A vertex of one shape, and the one across, that shall get counterparts on the other.
struct Transfer {
  bool on_a = true;  ///< whose vertices they are
  int vertex = 0;
  int twin = -1;  ///< the vertex across, which goes with it, or -1
  PairKind kind = PairKind::Tip;
  int base = 0;            ///< the vertex whose counterpart is looked for: where a tip grows
  int twin_base = 0;       ///< likewise of the twin
  bool is_middle = false;  ///< whether the vertex is its own mirror image
};

/// Adds a vertex and its twin with their counterparts, unless landmarks are there already.
///
/// @param most  how many pairs may be added; less than needed adds none
/// @return      how many came to be
int add_transferred(Correspondences& all, const Transfer& transfer, int most);

}  // namespace morphbake
