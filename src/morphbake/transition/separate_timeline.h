#pragma once

#include <optional>
#include <string>
#include <vector>

#include "morphbake/transition/timeline.h"

namespace morphbake {

/// One fixed field of a separable timeline.
struct TransitionField {
  std::string name;          ///< the track's or the state's; products of tracks are joined by "+"
  Eigen::MatrixXd change;    ///< dT: #sources by #V, or 3 #V as TransitionState; columns sum to 0
  std::vector<int> factors;  ///< tracks whose amounts are multiplied, or one state (with keys)
};

/// T(t) = reference + fields[0] + sum_k phi_k(t) fields[k]: fixed fields with coefficients that
/// depend on time alone, as changes from a reference that is the same at every vertex.
///
/// Right-hand sides are linear in T and the matrix is constant, so one solve a field gives every
/// frame. Tracks give one field each, and products where tracks overlap in space and time; keys one
/// a state.
struct SeparableTimeline {
  Shares reference;  ///< of the start: its mix without edits
  std::vector<TransitionField> fields;
};

/// Whether the timeline is separable: no track floods, and no track or key has a region that moves.
bool is_separable(const Recipe& recipe, const RegionFields& regions);

/// A timeline of more fields is solved frame by frame.
constexpr std::size_t kMostFields = 256;

/// @param recipe  whose timeline is separable
/// @return        none where it has more than kMostFields
std::optional<SeparableTimeline> separate_timeline(const Recipe& recipe,
                                                   const RegionFields& regions,
                                                   Eigen::Index vertex_count);

/// The timeline that is one state for ever.
SeparableTimeline separate_state(const State& state, const RegionFields& regions,
                                 Eigen::Index vertex_count);

/// phi at `time`: one a field, the first is 1, all in [0, 1].
Eigen::VectorXd field_coefficients(const Timeline& timeline, const SeparableTimeline& separable,
                                   double time);

/// Coefficients just before `time`, where a step has not happened yet.
Eigen::VectorXd field_coefficients_before(const Timeline& timeline,
                                          const SeparableTimeline& separable, double time);

}  // namespace morphbake
