#include "morphbake/transition/separate_timeline.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

using Factors = std::vector<int>;  // rising track indices; empty is the start

/// Whether track `a` has come to its end before track `b` begins to move.
bool is_done_before(const Track& a, const Track& b) {
  const double begin = b.ease.kind == Ease::Step ? b.end : b.begin;
  return a.edit.amount == 1 && a.end <= begin;
}

/// Amounts that are 1 whenever another factor is not 0 change nothing and are left out.
Factors reduced(const Factors& factors, const std::vector<Track>& tracks) {
  Factors kept;
  for (const int a : factors) {
    const bool redundant = std::any_of(factors.begin(), factors.end(), [&](int b) {
      const Track& first = tracks[static_cast<std::size_t>(a)];
      const Track& second = tracks[static_cast<std::size_t>(b)];
      // Two that jump at one moment are each done before the other: the later in the list stays.
      const bool tie = is_done_before(second, first) && b < a;
      return a != b && is_done_before(first, second) && !tie;
    });
    if (!redundant) kept.push_back(a);
  }
  return kept;
}

std::string joined_names(const Factors& factors, const std::vector<Track>& tracks) {
  std::string name;
  for (const int track : factors) {
    if (!name.empty()) name += "+";
    name += tracks[static_cast<std::size_t>(track)].name;
  }
  return name;
}

/// The amount that a coefficient of 1 stands for. Coefficients become weights, which engines clamp
/// to [0, 1]: what goes beyond is folded into the field.
double field_unit(const Edit& edit) {
  return edit.amount >= 0 && edit.amount <= 1 ? 1 : edit.amount;
}

/// The fields of all products of amounts so far.
using Terms = std::map<Factors, Eigen::MatrixXd>;

void add_term(Terms& terms, const Factors& factors, const Eigen::MatrixXd& field) {
  if ((field.array() == 0).all()) return;
  const auto [entry, is_new] = terms.try_emplace(factors, field);
  if (!is_new) entry->second += field;
}

/// m S of an edit, at every vertex and axis: #sources by #V, or 3 #V.
Eigen::MatrixXd edited_part(const Shares& to, const Eigen::RowVectorXd& m) {
  Eigen::MatrixXd part(to.rows(), to.cols() * m.size());
  for (Eigen::Index axis = 0; axis < to.cols(); ++axis) {
    part.middleCols(axis * m.size(), m.size()) = to.col(axis) * m;
  }
  return part;
}

/// Expands T <- (1 - a m) T + a m S track by track, with a(t) kept symbolic and m = 1 - d; none
/// where there are too many.
std::optional<Terms> expand_tracks(const Recipe& recipe, const RegionFields& regions,
                                   Eigen::Index vertex_count) {
  const std::vector<Track>& tracks = recipe.timeline.tracks;
  Terms terms;
  terms[{}] = uniform_transition(recipe.timeline.start, vertex_count);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Edit& edit = tracks[i].edit;
    const double unit = field_unit(edit);
    const Eigen::RowVectorXd m = edit_shares(edit, regions, vertex_count, {0, unit});
    const Terms before = terms;
    const Factors alone = {static_cast<int>(i)};
    add_term(terms, alone, edited_part(edit.to, m));
    const Eigen::RowVectorXd at_each_axis = m.replicate(1, edit.to.cols());
    for (const auto& [factors, field] : before) {
      Factors product = factors;
      product.push_back(static_cast<int>(i));
      add_term(terms, reduced(product, tracks),
               -(field.array().rowwise() * at_each_axis.array()).matrix());
    }
    if (terms.size() > kMostFields) return std::nullopt;
  }
  return terms;
}

std::optional<SeparableTimeline> separate_tracks(const Recipe& recipe, const RegionFields& regions,
                                                 Eigen::Index vertex_count) {
  std::optional<Terms> terms = expand_tracks(recipe, regions, vertex_count);
  if (!terms) return std::nullopt;
  SeparableTimeline separable{recipe.timeline.start, {}};
  for (auto& [factors, field] : *terms) {
    if (factors.empty()) field -= uniform_transition(recipe.timeline.start, vertex_count);
    // Terms that cancelled, as where a track leads to what is there already, move nothing. Rounding
    // of a sum of shares is at most a few epsilon.
    if (!factors.empty() && field.cwiseAbs().maxCoeff() < 1e-14) continue;
    separable.fields.push_back({joined_names(factors, recipe.timeline.tracks), field, factors});
  }
  return separable;
}

SeparableTimeline separate_keys(const Recipe& recipe, const RegionFields& regions,
                                Eigen::Index vertex_count) {
  const std::vector<Key>& keys = recipe.timeline.keys;
  const int first = keys.front().state;
  const auto state = [&](int index) -> const State& {
    return recipe.states[static_cast<std::size_t>(index)];
  };
  const TransitionState start = state_transition(state(first), regions, vertex_count);
  SeparableTimeline separable = separate_state(state(first), regions, vertex_count);
  separable.fields[0].factors = {first};
  for (const Key& key : keys) {
    const bool known =
        std::any_of(separable.fields.begin(), separable.fields.end(),
                    [&](const TransitionField& field) { return field.factors[0] == key.state; });
    if (known) continue;
    const TransitionState T = state_transition(state(key.state), regions, vertex_count);
    separable.fields.push_back({state(key.state).name, T - start, {key.state}});
  }
  return separable;
}

/// Shares of the two keys around `time`, added up per state.
Eigen::VectorXd key_coefficients(const Timeline& timeline, const SeparableTimeline& separable,
                                 double time, bool before) {
  const std::vector<Key>& keys = timeline.keys;
  Eigen::VectorXd phi = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(separable.fields.size()));
  const auto add = [&](const Key& key, double share) {
    for (std::size_t k = 1; k < separable.fields.size(); ++k) {
      if (separable.fields[k].factors[0] == key.state) phi(static_cast<Eigen::Index>(k)) += share;
    }
  };
  std::size_t next = 0;
  while (next < keys.size() && (before ? keys[next].time < time : keys[next].time <= time)) ++next;
  if (next == 0 || next == keys.size()) {
    add(next == 0 ? keys.front() : keys.back(), 1);
  } else {
    const Key& last = keys[next - 1];
    const double u = (time - last.time) / (keys[next].time - last.time);
    const bool holds = before && keys[next].ease.kind == Ease::Step;
    const double share = holds ? 0 : eased(keys[next].ease, u);
    add(last, 1 - share);
    add(keys[next], share);
  }
  phi(0) = 1;
  return phi;
}

double track_amount_before(const Track& track, double time) {
  const bool jumps = track.ease.kind == Ease::Step || track.begin == track.end;
  if (jumps) return time > track.end ? track.edit.amount : 0;
  return track_amount(track, time);
}

Eigen::VectorXd track_coefficients(const Timeline& timeline, const SeparableTimeline& separable,
                                   double time, bool before) {
  Eigen::VectorXd phi = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(separable.fields.size()));
  for (std::size_t k = 1; k < separable.fields.size(); ++k) {
    for (const int track : separable.fields[k].factors) {
      const Track& factor = timeline.tracks[static_cast<std::size_t>(track)];
      phi(static_cast<Eigen::Index>(k)) *=
          (before ? track_amount_before(factor, time) : track_amount(factor, time)) /
          field_unit(factor.edit);
    }
  }
  return phi;
}

Eigen::VectorXd coefficients(const Timeline& timeline, const SeparableTimeline& separable,
                             double time, bool before) {
  return timeline.keys.empty() ? track_coefficients(timeline, separable, time, before)
                               : key_coefficients(timeline, separable, time, before);
}

}  // namespace

bool is_separable(const Recipe& recipe, const RegionFields& regions) {
  const auto moves = [&](const Edit& edit) {
    return edit.region >= 0 && regions[static_cast<std::size_t>(edit.region)].moves;
  };
  const auto changes = [&](const Track& track) {
    const int region = track.edit.region;
    return moves(track.edit) || (region >= 0 && regions[static_cast<std::size_t>(region)].floods);
  };
  const Timeline& timeline = recipe.timeline;
  const auto key_moves = [&](const Key& key) {
    const State& state = recipe.states[static_cast<std::size_t>(key.state)];
    return std::any_of(state.edits.begin(), state.edits.end(), moves);
  };
  return std::none_of(timeline.tracks.begin(), timeline.tracks.end(), changes) &&
         std::none_of(timeline.keys.begin(), timeline.keys.end(), key_moves);
}

std::optional<SeparableTimeline> separate_timeline(const Recipe& recipe,
                                                   const RegionFields& regions,
                                                   Eigen::Index vertex_count) {
  if (recipe.timeline.keys.empty()) return separate_tracks(recipe, regions, vertex_count);
  return separate_keys(recipe, regions, vertex_count);
}

SeparableTimeline separate_state(const State& state, const RegionFields& regions,
                                 Eigen::Index vertex_count) {
  const Eigen::MatrixXd change =
      state_transition(state, regions, vertex_count) - uniform_transition(state.mix, vertex_count);
  return {state.mix, {{state.name, change, {}}}};
}

Eigen::VectorXd field_coefficients(const Timeline& timeline, const SeparableTimeline& separable,
                                   double time) {
  return coefficients(timeline, separable, time, false);
}

Eigen::VectorXd field_coefficients_before(const Timeline& timeline,
                                          const SeparableTimeline& separable, double time) {
  return coefficients(timeline, separable, time, true);
}

}  // namespace morphbake
