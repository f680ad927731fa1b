#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "morphbake/recipe/landmark.h"

namespace morphbake {

/// A part of the spectrum of the Laplacian (Alexa 2003, section 5.1).
struct BandSource {
  int first = 0;            ///< of the eigenvectors that are kept, in rising frequency
  std::optional<int> last;  ///< likewise; none: up to the highest
};

/// Scaled, then turned, then moved.
struct Movement {
  Eigen::Vector3d translate = Eigen::Vector3d::Zero();  ///< in `Recipe::units`
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();      ///< any length but 0
  double degrees = 0;                                   ///< counter-clockwise seen against it
  double scale = 1;
  std::optional<Eigen::Vector3d> scale_along;  ///< only in this direction; none: in all
};

/// Where a handle is, of the edited shape.
struct HandleTarget {
  int source = 0;  ///< on whose surface `at` lies
  Place at;
};

/// Vertices of an edit that go where they are told.
struct EditHandle {
  int region = -1;                          ///< its inside; -1: the vertex nearest to `at`
  Place at;                                 ///< on the file from which the edited shape comes
  std::variant<Movement, HandleTarget> to;  ///< movements are about the handle's own centre
};

/// Free-form modeling (Alexa 2003, section 6): what is outside of `region` stays, handles move, the
/// rest relaxes.
struct EditSource {
  int region = -1;
  bool turns = false;  ///< whether what is free turns and grows with the handles
  std::vector<EditHandle> handles;
};

/// The mirrored shape, left and right exchanged.
struct MirrorSource {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< of the plane
  double offset = 0;                                  ///< of the plane along it, in scene units
  int symmetric = -1;  ///< shape whose two sides are alike: tells which vertex is whose counterpart
};

/// Moved as a whole, about its centre of mass.
struct TransformSource {
  Movement movement;
};

/// A source that is made from another.
struct DerivedSource {
  std::string name;
  int of = 0;  ///< shape: index of a source with a file, or their number plus that of a derived one
  int root = 0;  ///< the source with a file from which it comes
  std::variant<BandSource, EditSource, MirrorSource, TransformSource> how;
};

}  // namespace morphbake
