#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/transition/region_fields.h"

namespace morphbake {

/// The paper's {T_i}: #sources by #V, row i is the diagonal of T_i; every column sums to 1. In a
/// recipe that has shares an axis it is #sources by 3 #V: all vertices' x, then y, then z.
using TransitionState = Eigen::MatrixXd;

/// Eased share of a segment at `share` in [0, 1]: 0 at 0, 1 at 1. Step stays 0 until 1.
double eased(const Easing& easing, double share);

/// Amount of a track at `time`, in [0, track.edit.amount].
double track_amount(const Track& track, double time);

/// sum_s T_s V_s for shares that are the same at every vertex.
Positions mixed_positions(const MorphableMesh& mesh, const Shares& shares);

/// T with the same shares at every vertex.
TransitionState uniform_transition(const Shares& shares, Eigen::Index vertex_count);

/// How much of an edit each vertex takes: a (1 - d), or what a flood has reached by a.
///
/// @return  #V
Eigen::RowVectorXd edit_shares(const Edit& edit, const RegionFields& regions,
                               Eigen::Index vertex_count, const RegionMoment& moment);

/// T with an edit applied: (1 - m) T + m T~.
///
/// @param m  #V, as edit_shares
/// @see      Alexa 2003, eq. 7
TransitionState apply_edit(const TransitionState& T, const Edit& edit, const Eigen::RowVectorXd& m);

/// T of a state at `time`: its mix with its edits in order.
TransitionState state_transition(const State& state, const RegionFields& regions,
                                 Eigen::Index vertex_count, double time = 0);

/// T at `time`, by applying the tracks in order or interpolating the keys in matrix space.
TransitionState transition_at(const Recipe& recipe, const RegionFields& regions,
                              Eigen::Index vertex_count, double time);

/// The shapes that have a share in any track or state, in order; the first where none.
std::vector<int> shapes_with_a_share(const Recipe& recipe);

/// The sources with a file that have a share in any track or state, or from which a shape with a
/// share is derived, in order; the first where none.
std::vector<int> sources_with_a_share(const Recipe& recipe);

/// Times at which the timeline may bend or jump: rising, from 0 to the duration.
std::vector<double> timeline_breaks(const Timeline& timeline);

/// Frame times: 0, 1 / fps, ... up to the duration, which is the last.
std::vector<double> frame_times(const Timeline& timeline);

}  // namespace morphbake
