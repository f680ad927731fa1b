#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/differential/deformation.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/linear/multigrid.h"
#include "morphbake/linear/unknowns.h"
#include "morphbake/solve/displacement_system.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// How all shapes of a mesh are turned against the first.
struct SourceDeformations {
  std::vector<Edge> edges;
  std::vector<Deformation> against_first;  ///< one a further source
};

SourceDeformations source_deformations(const MorphableMesh& mesh);

struct LaneFrames;
struct LaneQuaternion;
struct TurnedShapes;

/// A shape by its differences.
struct BlendedShape {
  Positions differences;           ///< #V by 3: b of K_L V = b, sums to 0 over each component
  std::optional<Positions> start;  ///< #V by 3: nearly V, but for a translation a component
};

/// Blends shapes that are turned against one another: their rotations along edges, and the edges
/// themselves as they are when they are turned back. Edges keep their lengths, bent parts their
/// volume.
///
/// Along an edge (a, b) source s turns by l_s = log(R_a^T R_b) against the first one: little,
/// however far the shapes are turned. Those of a transition state are sum_s T_s l_s; the rotations
/// that fit all of them best are found by Gauss-Newton steps that share one factor.
/// @see  docs/method.md, "Shapes that are turned"; Lipman et al. 2005, Linear rotation-invariant
///       coordinates
class RotationBlend {
 public:
  struct Effort {
    bool makes_factor = true;  ///< else they are solved by conjugate gradients, with less memory
    int frames = 1;            ///< that will be asked for
    StageCache orders = {};    ///< as of a factor
  };

  /// @param mesh          must outlive this
  /// @param deformations  of its sources
  /// @param system        of the mesh: what is held and where the rest stands
  /// @param reference     shares of what is held: #sources by 1
  /// @param effort        how its systems are solved
  /// @param observer      is asked whether to stop; must outlive this
  /// @throws BakeError "linear.out-of-memory"; Cancelled, here and wherever shapes are asked for
  RotationBlend(const MorphableMesh& mesh, std::shared_ptr<const SourceDeformations> deformations,
                const DisplacementSystem& system, const Eigen::VectorXd& reference,
                const Effort& effort, const Observer& observer);
  ~RotationBlend();

  /// The rotations of transition states: least squares of log(R_a exp(sum_s T_s l_s) R_b^T).
  ///
  /// What is held is turned as the reference, and components that hold nothing as their sources'
  /// mix at one vertex in their midst. May be called from several threads.
  /// @param states  #sources by #V each; they share the passes over the factor
  std::vector<RotationField> rotations(std::span<const TransitionState> states) const;

  /// The shapes of transition states. May be called from several threads. Where nothing is held the
  /// rotations are fitted to the shape that they give, as ARAP does, but for what that does to the
  /// sources themselves, which stay exact.
  ///
  ///   b_a = sum_b sum_s (T_s,a R_a R_s,a^T + T_s,b R_b R_s,b^T) e_s / 2
  ///
  /// with the edge e_s of each source. It is exact where T is one source.
  std::vector<BlendedShape> shapes(std::span<const TransitionState> states) const;

  /// Where something is held: the differences of the reference's shape, held nowhere, not fitted.
  const Positions& reference_differences() const { return reference_differences_; }

  /// Of K_L of what is not held; of the system's equations where nothing is. May be none.
  std::shared_ptr<const CholeskyFactor> factor() const { return factor_; }

 private:
  void hold(const std::vector<bool>& held, const Eigen::VectorXd& reference);
  void factorise();
  void fit_sources();
  LaneFrames first_guess(std::span<const TransitionState> states) const;
  std::vector<LaneFrames> synchronised(std::span<const TransitionState> states) const;
  void fit(std::vector<LaneFrames>& groups) const;
  void solve_in_place(ColumnRows& columns) const;
  std::vector<Positions> differences_of(const std::vector<LaneFrames>& groups) const;
  std::vector<LaneQuaternion> rotations_at_roots(const LaneFrames& frames) const;

  const MorphableMesh& mesh_;
  std::shared_ptr<const SourceDeformations> source_deformations_;
  const std::vector<Edge>& edges_;                ///< of the above
  const std::vector<Deformation>& deformations_;  ///< likewise
  std::unique_ptr<TurnedShapes> turned_;
  Components components_;
  std::vector<bool> held_;
  bool holds_;
  Eigen::VectorXd gauge_;
  std::vector<int> root_;            ///< one a component; -1 where something is held
  RotationField reference_;          ///< #V where something is held: the rotations of what is
  Positions reference_differences_;  ///< likewise
  Unknowns unknowns_;                ///< what is not held
  SymmetricSystem equations_;        ///< K_L of what is not held
  Effort effort_;
  const Observer& observer_;
  std::shared_ptr<const CholeskyFactor> factor_;
  std::unique_ptr<const Multigrid> multigrid_;  ///< instead
};

}  // namespace morphbake
