#pragma once

#include <string>
#include <vector>

#include "morphbake/solve/surface_solver.h"
#include "morphbake/transition/separate_timeline.h"

namespace morphbake {

/// One solve: of what, and how it went.
struct SolveRecord {
  std::string name;  ///< the field's, or "" for a frame
  double time = 0;   ///< seconds; of a frame
  Convergence convergence;
};

/// The shapes whose combinations are all frames of a separable timeline.
struct SolvedShapes {
  Positions base;                        ///< #V by 3, solution of the first field
  std::vector<std::string> names;        ///< one a further field
  std::vector<Positions> displacements;  ///< one a further field: #V by 3
  std::vector<SolveRecord> records;      ///< one a field that needed a solve
};

/// Displacement from the reference for one goal.
///
/// @param records  gets one more when a solve was needed
Positions solve_goal(const SurfaceSolver& solver, Goal goal, const std::string& name,
                     std::vector<SolveRecord>& records);

/// Displacement from the reference for a change of shares.
///
/// Components in which every vertex changes alike take the linear blend itself, which is the
/// solution (Alexa 2003, section 5) without its rounding.
/// @param change   #sources by #V, or 3 #V as TransitionState; columns sum to 0
/// @param records  gets one more when a solve was needed
Positions solve_change(const SurfaceSolver& solver, const Eigen::MatrixXd& change,
                       const std::string& name, std::vector<SolveRecord>& records);

SolvedShapes solve_fields(const SurfaceSolver& solver, const MorphableMesh& mesh,
                          const SeparableTimeline& timeline, const Observer& observer);

/// base + sum_k phi_k displacement_k.
///
/// @param phi  as field_coefficients: the first is 1
Positions combine_shapes(const SolvedShapes& shapes, const Eigen::VectorXd& phi);

/// The same of `count` vertices from `first` on.
Positions combine_shapes(const SolvedShapes& shapes, const Eigen::VectorXd& phi, Eigen::Index first,
                         Eigen::Index count);

}  // namespace morphbake
