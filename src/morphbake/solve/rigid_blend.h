#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// Interpolates positions once each component of each source lies on the first source as well as a
/// motion can bring it, and moves it along: what is common before morphing relative coordinates.
/// A component moves as its mean shares say.
/// @see Alexa 2003, section 1, "A rigid [5, 6] or affine [1] transform prior to linear vertex
///      interpolation"; Umeyama 1991
class RigidBlend {
 public:
  /// @param gauge  #V: weights of the means; they sum to 1 over each component
  RigidBlend(const MorphableMesh& mesh, Eigen::VectorXd gauge);

  /// #V by 3
  Positions shape(const TransitionState& T) const;

 private:
  /// How one source's component lies against the first source's.
  struct Motion {
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< axis times angle
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< of the source
  };

  Components components_;
  Eigen::VectorXd gauge_;
  std::vector<std::vector<Motion>> motions_;  ///< [source][component]
  std::vector<Positions> aligned_;            ///< one a source: about 0, turned as the first
};

}  // namespace morphbake
