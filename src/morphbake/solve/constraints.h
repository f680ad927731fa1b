#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/transition/separate_timeline.h"

namespace morphbake {

/// What stands still, and where the rest stands; chosen once for a whole timeline, so that nothing
/// pops.
struct Constraints {
  std::vector<bool> held;   ///< #V: hard constraints, at sum_s T_s V_s
  Eigen::VectorXd gauge;    ///< #V: the centroid with these weights follows sum_s T_s V_s; they sum
                            ///< to 1 over each component that holds nothing
  std::vector<int> anchor;  ///< one a component: the vertex whose equation is dropped, or -1
};

enum class HoldRule {
  Untouched,  ///< what no edit ever touches, where that is 5 % of a component's area
  Nothing,
  Given,  ///< ConstraintRequest::held
};

/// What a recipe asks for.
struct ConstraintRequest {
  HoldRule hold = HoldRule::Untouched;
  std::vector<bool> held;         ///< #V for HoldRule::Given
  Eigen::VectorXd gauge_weights;  ///< #V, >= 0; components without any, or no rows: chosen by area
  int anchor = -1;                ///< vertex, -1 for none
};

/// Vertices whose shares are the timeline's reference shares at all times: of none of the changes
/// from them, which are those of all fields or of all frames.
class UntouchedVertices {
 public:
  explicit UntouchedVertices(Eigen::Index vertex_count)
      : untouched_(static_cast<std::size_t>(vertex_count), true) {}

  /// @param change  #sources by #V, or 3 #V as TransitionState
  void add(const Eigen::MatrixXd& change);

  const std::vector<bool>& mask() const { return untouched_; }

 private:
  std::vector<bool> untouched_;
};

/// Of a separable timeline.
std::vector<bool> untouched_vertices(const SeparableTimeline& timeline);

/// @param untouched  #V
/// @see              docs/method.md, "What stays" and "Where it stands"
Constraints choose_constraints(const MorphableMesh& mesh, const Components& components,
                               const std::vector<bool>& untouched,
                               const ConstraintRequest& request);

}  // namespace morphbake
