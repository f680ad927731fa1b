#include "morphbake/transition/timeline.h"

#include <algorithm>
#include <cmath>

namespace morphbake {
namespace {

TransitionState transition_between_keys(const Recipe& recipe,
                                        const std::vector<Eigen::VectorXd>& regions,
                                        Eigen::Index vertex_count, double time) {
  const std::vector<Key>& keys = recipe.timeline.keys;
  const auto state = [&](const Key& key) {
    return state_transition(recipe.states[static_cast<std::size_t>(key.state)], regions,
                            vertex_count);
  };
  const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                     [](double t, const Key& key) { return t < key.time; });
  if (next == keys.begin()) return state(keys.front());
  if (next == keys.end()) return state(keys.back());
  const Key& last = *(next - 1);
  const double share = eased(next->ease, (time - last.time) / (next->time - last.time));
  return (1 - share) * state(last) + share * state(*next);
}

}  // namespace

double eased(Ease ease, double share) {
  const double u = std::clamp(share, 0.0, 1.0);
  switch (ease) {
    case Ease::Linear:
      return u;
    case Ease::Step:
      return u < 1 ? 0 : 1;
    case Ease::Smoothstep:
      return u * u * (3 - 2 * u);
    case Ease::Cubic:
      return u < 0.5 ? 4 * u * u * u : 1 - 4 * (1 - u) * (1 - u) * (1 - u);
  }
  return u;
}

double track_amount(const Track& track, double time) {
  if (time >= track.end) return track.edit.amount;
  if (time <= track.begin) return 0;
  return track.edit.amount * eased(track.ease, (time - track.begin) / (track.end - track.begin));
}

TransitionState uniform_transition(const Shares& shares, Eigen::Index vertex_count) {
  return Eigen::Map<const Eigen::VectorXd>(shares.data(), static_cast<Eigen::Index>(shares.size()))
      .replicate(1, vertex_count);
}

TransitionState apply_edit(const TransitionState& T, const Edit& edit, double amount,
                           const std::vector<Eigen::VectorXd>& regions) {
  Eigen::RowVectorXd share = Eigen::RowVectorXd::Constant(T.cols(), amount);
  if (edit.region >= 0) {
    share = amount * (1 - regions[static_cast<std::size_t>(edit.region)].transpose().array());
  }
  TransitionState edited = T;
  for (Eigen::Index s = 0; s < T.rows(); ++s) {
    const double to = edit.to[static_cast<std::size_t>(s)];
    edited.row(s) = (1 - share.array()) * T.row(s).array() + share.array() * to;
  }
  return edited;
}

TransitionState state_transition(const State& state, const std::vector<Eigen::VectorXd>& regions,
                                 Eigen::Index vertex_count) {
  TransitionState T = uniform_transition(state.mix, vertex_count);
  for (const Edit& edit : state.edits) T = apply_edit(T, edit, edit.amount, regions);
  return T;
}

TransitionState transition_at(const Recipe& recipe, const std::vector<Eigen::VectorXd>& regions,
                              Eigen::Index vertex_count, double time) {
  if (!recipe.timeline.keys.empty())
    return transition_between_keys(recipe, regions, vertex_count, time);
  TransitionState T = uniform_transition(recipe.timeline.start, vertex_count);
  for (const Track& track : recipe.timeline.tracks) {
    T = apply_edit(T, track.edit, track_amount(track, time), regions);
  }
  return T;
}

std::vector<double> timeline_breaks(const Timeline& timeline) {
  std::vector<double> breaks = {0, timeline.duration};
  const auto add_segment = [&](double begin, double end, Ease ease) {
    breaks.insert(breaks.end(), {begin, end});
    if (ease == Ease::Cubic) breaks.push_back((begin + end) / 2);  // its halves join there
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
