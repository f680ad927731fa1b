#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// The paper's {T_i}: #sources by #V, row i is the diagonal of T_i; every column sums to 1.
using TransitionState = Eigen::MatrixXd;

/// Eased share of a segment at `share` in [0, 1]: 0 at 0, 1 at 1. Step stays 0 until 1.
double eased(Ease ease, double share);

/// Amount of a track at `time`, in [0, track.edit.amount].
double track_amount(const Track& track, double time);

/// T with the same shares at every vertex.
TransitionState uniform_transition(const Shares& shares, Eigen::Index vertex_count);

/// T with an edit applied: (1 - a (1 - d)) T + a (1 - d) T~.
///
/// @param regions  d of every region, as region_distances
/// @see            Alexa 2003, eq. 7
TransitionState apply_edit(const TransitionState& T, const Edit& edit, double amount,
                           const std::vector<Eigen::VectorXd>& regions);

/// T of a state: its mix with its edits in order.
TransitionState state_transition(const State& state, const std::vector<Eigen::VectorXd>& regions,
                                 Eigen::Index vertex_count);

/// T at `time`, by applying the tracks in order or interpolating the keys in matrix space.
TransitionState transition_at(const Recipe& recipe, const std::vector<Eigen::VectorXd>& regions,
                              Eigen::Index vertex_count, double time);

/// Times at which the timeline may bend or jump: rising, from 0 to the duration.
std::vector<double> timeline_breaks(const Timeline& timeline);

/// Frame times: 0, 1 / fps, ... up to the duration, which is the last.
std::vector<double> frame_times(const Timeline& timeline);

}  // namespace morphbake
