#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/differential/deformation.h"
#include "morphbake/linear/symmetric_system.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/solve/frame_lanes.h"
#include "morphbake/solve/rotation_tree.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// Shapes of a mesh and what turns them, as the passes over its edges read it.
struct TurnedShapes {
  const MorphableMesh* mesh = nullptr;
  OneRings rings;
  const std::vector<Edge>* edges = nullptr;
  const std::vector<Deformation>* deformations = nullptr;  ///< one a further source
  std::vector<std::vector<Eigen::Matrix3d>> back;          ///< [further source][vertex]: R^T
  /// [further source][vertex]: log(R^T F) of what fit_rotations() makes of the source itself.
  std::vector<std::vector<Eigen::Vector3d>> own_fits;
  std::vector<TreeStep> tree;  ///< from where rotations are given outwards
};

/// Frames beside each other while they are blended.
struct LaneFrames {
  std::vector<LaneNumber> shares;         ///< [vertex][source]
  std::vector<LaneQuaternion> rotations;  ///< [vertex]
  std::vector<LaneVector> shape;          ///< [vertex]

  /// @param states  at most kLanes; lanes behind the last one repeat it
  explicit LaneFrames(std::span<const TransitionState> states);
};

/// Of right-hand sides and of solutions: for each group of frames the lanes of x, y and z.
inline constexpr int kGroupColumns = 3 * kLanes;

/// The shape as sum_s T_s V_s, vertex by vertex.
void mix_sources(const TurnedShapes& shapes, LaneFrames& frames);

/// Moves the shape.
void move_by(const ColumnRows& moves, int group, LaneFrames& frames);

/// Turns each component, and its shape where there is one, so that its root has a given rotation.
///
/// @param roots      one a component; components with -1 stay
/// @param rotations  one a component
void turn_components(const Components& components, std::span<const int> roots,
                     std::span<const LaneQuaternion> rotations, LaneFrames& frames);

/// R_to = R_from exp(sum_s T_s l_s), step by step.
void turn_along_tree(const TurnedShapes& shapes, LaneFrames& frames);

/// -sum_b log(R_a exp(sum_s T_s l_s) R_b^T) into the rows of unknown vertices.
///
/// @param unknown  #V: rows of b, or -1
void put_misfits(const TurnedShapes& shapes, const LaneFrames& frames, std::span<const int> unknown,
                 int group, ColumnRows& b);

/// R <- exp(phi) R in lanes that move still.
///
/// @param moves  one a lane; false from the step on that turns nothing by more than `settled`
void turn_by(const ColumnRows& phi, int group, std::span<const int> unknown, double settled,
             std::span<bool> moves, LaneFrames& frames);

/// b of K_L V = b, or what the frames' shape leaves of it:
///
///   b_a = sum_b sum_s (T_s,a R_a R_s,a^T + T_s,b R_b R_s,b^T) e_s / 2 - (V_a - V_b)
enum class Left { Differences, Residual };
void put_differences(const TurnedShapes& shapes, const LaneFrames& frames, Left what, int group,
                     ColumnRows& b);

/// Turns each vertex towards the rotation that fits the frames' shape best, as ARAP does, but for
/// what that does to the sources themselves.
///
/// @param relaxation  how far: 1 is there
void fit_rotations(const TurnedShapes& shapes, double relaxation, LaneFrames& frames);

}  // namespace morphbake
