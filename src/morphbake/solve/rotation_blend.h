#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/differential/deformation.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/solve/displacement_system.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// How all shapes of a mesh are turned and stretched against the first.
struct SourceDeformations {
  std::vector<Edge> edges;
  std::vector<Deformation> against_first;  ///< one a further source
};

SourceDeformations source_deformations(const MorphableMesh& mesh);

/// Blends shapes that are turned against one another: the rotations of their gradients edge by
/// edge, what they stretch vertex by vertex. Edges keep their lengths, bent parts their volume.
///
/// Along an edge (a, b) source s turns by l_s = log(R_a^T R_b) against the first one: little,
/// however far the shapes are turned. Those of a transition state are sum_s T_s l_s; the rotations
/// that fit all of them best are found by Gauss-Newton steps that share one factor. Then they are
/// fitted to the shape that they give, as ARAP does, but for what the sources' own rotations are
/// off by such a fit: a source stays exact.
/// @see  docs/method.md, "Shapes that are turned"; Lipman et al. 2005, Linear rotation-invariant
///       coordinates
class RotationBlend {
 public:
  /// @param mesh          must outlive this
  /// @param deformations  of its sources
  /// @param reference     shares of what is held: #sources by 1
  /// @throws BakeError "linear.out-of-memory"
  RotationBlend(const MorphableMesh& mesh, std::shared_ptr<const SourceDeformations> deformations,
                const Constraints& constraints, const Eigen::VectorXd& reference);

  /// The rotations of transition states: least squares of log(R_a exp(sum_s T_s l_s) R_b^T).
  ///
  /// What is held is turned as the reference, and components that hold nothing as their sources'
  /// mix at one vertex in their midst. May be called from several threads.
  /// @param states  #sources by #V each; they share the passes over the factor
  std::vector<RotationField> rotations(std::span<const TransitionState> states) const;

  /// b of K_L V = b: sums to 0 over each component.
  ///
  ///   b_a = sum_b (R_a (S_a e + r) + R_b (S_b e + r)) / 2
  ///
  /// with S = sum_s T_s S_s, the edge e of the first source, and r = sum_s T_s r_s, the sources'
  /// remainders along it. It is exact where T is one source.
  /// @return #V by 3
  Positions differences(const TransitionState& T, const RotationField& rotations) const;

 private:
  struct Step {
    int vertex = 0;
    int edge = 0;
    bool forward = false;  ///< from the edge's first vertex to its second
  };

  void choose_roots();
  void plan_tree();
  void factorise();
  Positions unrolled(const Deformation& deformation) const;
  Eigen::Vector3d turn_of(const TransitionState& T, std::size_t edge) const;
  RotationField first_guess(const TransitionState& T) const;
  Eigen::MatrixXd misfits(const TransitionState& T, const RotationField& rotations) const;
  double turn_by(const Eigen::MatrixXd& phi, RotationField& rotations) const;
  void turn_back(const RotationField& guess, RotationField& rotations) const;
  Positions shape_of(const TransitionState& T, const Positions& b) const;
  RotationField fitted(const TransitionState& T, const RotationField& near,
                       const Positions& shape) const;
  Eigen::Vector3d blended_edge(const TransitionState& T, const std::vector<Eigen::Matrix3d>& S,
                               std::size_t edge, bool at_first) const;
  std::vector<Eigen::Matrix3d> blended_stretches(const TransitionState& T) const;

  const MorphableMesh& mesh_;
  OneRings rings_;
  Components components_;
  std::shared_ptr<const SourceDeformations> source_deformations_;
  const std::vector<Edge>& edges_;                ///< of the above
  const std::vector<Deformation>& deformations_;  ///< likewise
  std::vector<bool> held_;
  Eigen::VectorXd gauge_;
  std::vector<std::vector<Eigen::Vector3d>> misfits_;  ///< [further source][vertex]: log(R^T fit)
  std::vector<int> root_;      ///< one a component; -1 where something is held
  std::vector<Step> tree_;     ///< from the roots and what is held outwards
  RotationField reference_;    ///< #V where something is held: the rotations of what is
  std::vector<int> unknown_;   ///< #V: -1 where held
  SymmetricSystem equations_;  ///< K_L of what is not held
  std::optional<CholeskyFactor> factor_;
};

}  // namespace morphbake
