#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/linear/laplacian_factor.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/transition/separate_timeline.h"

namespace morphbake {

/// Where a component's translation comes from, chosen once for the whole timeline: its
/// area-weighted centroid over the vertices with a weight follows the mixed sources.
struct TranslationGauge {
  Eigen::VectorXd
      weights;  ///< #V, summing to 1 over each component; 0 for vertices that do not count
};

/// Counts what no field but the first ever touches, if that is 5 % of a component's area, else all
/// of it.
///
/// @param fields  of the whole timeline
/// @see           docs/method.md
TranslationGauge choose_gauge(const MorphableMesh& mesh, const Components& components,
                              const std::vector<TransitionField>& fields);

/// The linear system of one morphable mesh: factorised once, solved for any transition state.
class LaplacianSystem {
 public:
  explicit LaplacianSystem(const MorphableMesh& mesh);

  const Components& components() const { return components_; }

  /// V' with K_L V' = b(T), translated to the gauge.
  ///
  /// @param weights  #sources by #V; a state, or a difference of states (everything is linear in T)
  /// @return         #V by 3, scene space
  /// @throws BakeError "solve.not-finite"
  Positions solve(const Eigen::MatrixXd& weights, const TranslationGauge& gauge) const;

  /// As solve; components in which every vertex has the same shares take the linear blend itself,
  /// which is the solution (Alexa 2003, section 5) without its rounding.
  Positions solve_or_blend(const Eigen::MatrixXd& weights, const TranslationGauge& gauge) const;

 private:
  const MorphableMesh& mesh_;
  OneRings rings_;
  Components components_;
  LaplacianFactor factor_;
};

/// The shapes whose combinations are all frames of a separable timeline.
struct SolvedShapes {
  Positions base;                        ///< #V by 3, solution of the first field
  std::vector<std::string> names;        ///< one a further field
  std::vector<Positions> displacements;  ///< one a further field: #V by 3
};

SolvedShapes solve_fields(const LaplacianSystem& system, const SeparableTimeline& timeline,
                          const TranslationGauge& gauge);

/// base + sum_k phi_k displacement_k.
///
/// @param phi  as field_coefficients: the first is 1
Positions combine_shapes(const SolvedShapes& shapes, const Eigen::VectorXd& phi);

}  // namespace morphbake
