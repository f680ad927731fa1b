#include "morphbake/transition/timeline.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace morphbake {
namespace {

TransitionState transition_between_keys(const Recipe& recipe, const RegionFields& regions,
                                        Eigen::Index vertex_count, double time) {
  const std::vector<Key>& keys = recipe.timeline.keys;
  const auto state = [&](const Key& key) {
    return state_transition(recipe.states[static_cast<std::size_t>(key.state)], regions,
                            vertex_count, time);
  };
  const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                     [](double t, const Key& key) { return t < key.time; });
  if (next == keys.begin()) return state(keys.front());
  if (next == keys.end()) return state(keys.back());
  const Key& last = *(next - 1);
  const double share = eased(next->ease, (time - last.time) / (next->time - last.time));
  return (1 - share) * state(last) + share * state(*next);
}

/// One coordinate of a cubic Bezier curve from 0 to 1 with inner control values a and b.
double bezier(double a, double b, double s) {
  return s * (3 * (1 - s) * ((1 - s) * a + s * b) + s * s);
}

/// y where the curve's x, which rises, is `u`.
double eased_by_curve(const std::array<double, 4>& control, double u) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (bezier(control[0], control[2], middle) < u ? low : high) = middle;
  }
  return bezier(control[1], control[3], (low + high) / 2);
}

}  // namespace

double eased(const Easing& easing, double share) {
  const double u = std::clamp(share, 0.0, 1.0);
  switch (easing.kind) {
    case Ease::Linear:
      return u;
    case Ease::Step:
      return u < 1 ? 0 : 1;
    case Ease::Smoothstep:
      return u * u * (3 - 2 * u);
    case Ease::Cubic:
      return u < 0.5 ? 4 * u * u * u : 1 - 4 * (1 - u) * (1 - u) * (1 - u);
    case Ease::Bezier:
      return u == 0 || u == 1 ? u : eased_by_curve(easing.control, u);
  }
  return u;
}

double track_amount(const Track& track, double time) {
  if (time >= track.end) return track.edit.amount;
  if (time <= track.begin) return 0;
  return track.edit.amount * eased(track.ease, (time - track.begin) / (track.end - track.begin));
}

Positions mixed_positions(const MorphableMesh& mesh, const Shares& shares) {
  Positions sum = Positions::Zero(mesh.connectivity.vertex_count, 3);
  for (Eigen::Index s = 0; s < shares.rows(); ++s) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double share = shares(s, shares.cols() == 1 ? 0 : axis);
      if (share == 0) continue;
      sum.col(axis) += share * mesh.geometries[static_cast<std::size_t>(s)].col(axis);
    }
  }
  return sum;
}

TransitionState uniform_transition(const Shares& shares, Eigen::Index vertex_count) {
  TransitionState T(shares.rows(), shares.cols() * vertex_count);
  for (Eigen::Index axis = 0; axis < shares.cols(); ++axis) {
    T.middleCols(axis * vertex_count, vertex_count) = shares.col(axis).replicate(1, vertex_count);
  }
  return T;
}

Eigen::RowVectorXd edit_shares(const Edit& edit, const RegionFields& regions,
                               Eigen::Index vertex_count, const RegionMoment& moment) {
  if (edit.region < 0) return Eigen::RowVectorXd::Constant(vertex_count, moment.amount);
  const Eigen::RowVectorXd inside =
      1 - distance_at(regions, edit.region, moment).transpose().array();
  const bool floods = regions[static_cast<std::size_t>(edit.region)].floods;
  return floods ? inside : (moment.amount * inside).eval();
}

TransitionState apply_edit(const TransitionState& T, const Edit& edit,
                           const Eigen::RowVectorXd& m) {
  TransitionState edited = T;
  const Eigen::Index count = m.size();
  for (Eigen::Index axis = 0; axis < edit.to.cols(); ++axis) {
    auto block = edited.middleCols(axis * count, count);
    for (Eigen::Index s = 0; s < T.rows(); ++s) {
      block.row(s) = (1 - m.array()) * block.row(s).array() + m.array() * edit.to(s, axis);
    }
  }
  return edited;
}

TransitionState state_transition(const State& state, const RegionFields& regions,
                                 Eigen::Index vertex_count, double time) {
  TransitionState T = uniform_transition(state.mix, vertex_count);
  for (const Edit& edit : state.edits) {
    T = apply_edit(T, edit, edit_shares(edit, regions, vertex_count, {time, edit.amount}));
  }
  return T;
}

TransitionState transition_at(const Recipe& recipe, const RegionFields& regions,
                              Eigen::Index vertex_count, double time) {
  if (!recipe.timeline.keys.empty())
    return transition_between_keys(recipe, regions, vertex_count, time);
  TransitionState T = uniform_transition(recipe.timeline.start, vertex_count);
  for (const Track& track : recipe.timeline.tracks) {
    const double amount = track_amount(track, time);
    if (amount == 0) continue;
    T = apply_edit(T, track.edit, edit_shares(track.edit, regions, vertex_count, {time, amount}));
  }
  return T;
}

namespace {

/// The source with a file from which a shape comes.
std::size_t file_of(const Recipe& recipe, std::size_t shape) {
  const std::size_t files = recipe.sources.size();
  return shape < files ? shape : static_cast<std::size_t>(recipe.derived[shape - files].root);
}

}  // namespace

std::vector<int> shapes_with_a_share(const Recipe& recipe) {
  std::vector<bool> has_share(recipe.sources.size() + recipe.derived.size(), false);
  const auto add = [&](const Shares& shares) {
    // Fitted shapes come after those that the recipe names.
    has_share.resize(std::max(has_share.size(), static_cast<std::size_t>(shares.rows())), false);
    for (Eigen::Index row = 0; row < shares.rows(); ++row) {
      if (!shares.row(row).isZero(0)) has_share[static_cast<std::size_t>(row)] = true;
    }
  };
  if (recipe.timeline.keys.empty()) add(recipe.timeline.start);
  for (const Track& track : recipe.timeline.tracks) add(track.edit.to);
  for (const State& state : recipe.states) {
    add(state.mix);
    for (const Edit& edit : state.edits) add(edit.to);
  }
  std::vector<int> shapes;
  for (std::size_t s = 0; s < has_share.size(); ++s) {
    if (has_share[s]) shapes.push_back(static_cast<int>(s));
  }
  if (shapes.empty()) shapes.push_back(0);
  return shapes;
}

std::vector<int> sources_with_a_share(const Recipe& recipe) {
  std::set<int> sources;
  for (const int shape : shapes_with_a_share(recipe)) {
    sources.insert(static_cast<int>(file_of(recipe, static_cast<std::size_t>(shape))));
  }
  return {sources.begin(), sources.end()};
}

std::vector<double> timeline_breaks(const Timeline& timeline) {
  std::vector<double> breaks = {0, timeline.duration};
  const auto add_segment = [&](double begin, double end, const Easing& easing) {
    breaks.insert(breaks.end(), {begin, end});
    if (easing.kind == Ease::Cubic) breaks.push_back((begin + end) / 2);  // its halves join there
  };
  for (const Track& track : timeline.tracks) add_segment(track.begin, track.end, track.ease);
  for (std::size_t k = 1; k < timeline.keys.size(); ++k) {
    add_segment(timeline.keys[k - 1].time, timeline.keys[k].time, timeline.keys[k].ease);
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  const auto is_outside = [&](double t) { return t < 0 || t > timeline.duration; };
  breaks.erase(std::remove_if(breaks.begin(), breaks.end(), is_outside), breaks.end());
  return breaks;
}

std::vector<double> frame_times(const Timeline& timeline) {
  // The tolerance keeps a duration that is a whole number of frames from gaining one by rounding.
  const double exact = timeline.duration * timeline.frames_per_second;
  const auto steps = std::max(1, static_cast<int>(std::ceil(exact - 1e-6)));
  std::vector<double> times;
  for (int f = 0; f < steps; ++f) times.push_back(f / timeline.frames_per_second);
  times.push_back(timeline.duration);
  return times;
}

}  // namespace morphbake
