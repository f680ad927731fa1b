#include "morphbake/bake/timeline_changes.h"

#include <fmt/core.h>

#include <utility>

#include "morphbake/solve/constraints.h"

namespace morphbake {
namespace {

constexpr double kChanging = 1e-12;  // shares that differ by no more are the same

bool is_changed(const Eigen::MatrixXd& change, Eigen::Index vertex, Eigen::Index count) {
  for (Eigen::Index column = vertex; column < change.cols(); column += count) {
    if (change.col(column).cwiseAbs().maxCoeff() > kChanging) return true;
  }
  return false;
}

/// Looks at every frame: where fields are not known there is no other way.
void survey_frames(const Timeline& timeline, Eigen::Index count, const Observer& observer,
                   TimelineChanges& changes) {
  UntouchedVertices untouched(count);
  changes.first_change.assign(static_cast<std::size_t>(count), -1);
  Eigen::MatrixXd start;
  for (const double time : frame_times(timeline)) {
    stop_if_cancelled(observer);
    const Eigen::MatrixXd change = changes.at(time);
    untouched.add(change);
    if (start.size() == 0) start = change;
    const Eigen::MatrixXd moved = change - start;
    for (Eigen::Index v = 0; v < count; ++v) {
      double& first = changes.first_change[static_cast<std::size_t>(v)];
      if (first < 0 && is_changed(moved, v, count)) first = time;
    }
  }
  changes.untouched = untouched.mask();
}

Shares start_of(const Recipe& recipe) {
  const Timeline& timeline = recipe.timeline;
  if (timeline.keys.empty()) return timeline.start;
  return recipe.states[static_cast<std::size_t>(timeline.keys.front().state)].mix;
}

}  // namespace

TimelineChanges changes_of_fields(SeparableTimeline separable) {
  TimelineChanges changes;
  changes.reference = separable.reference;
  changes.untouched = untouched_vertices(separable);
  changes.separable = std::move(separable);
  return changes;
}

TimelineChanges changes_of(const Recipe& recipe, const RegionFields& regions, Eigen::Index count,
                           std::optional<SeparableTimeline> separable, const Observer& observer) {
  TimelineChanges changes;
  if (separable) {
    changes = changes_of_fields(std::move(*separable));
  } else {
    changes.reference = start_of(recipe);
  }
  changes.at = [&recipe, &regions, count,
                start = uniform_transition(changes.reference, count)](double time) {
    return Eigen::MatrixXd(transition_at(recipe, regions, count, time) - start);
  };
  if (!changes.separable) survey_frames(recipe.timeline, count, observer, changes);
  return changes;
}

std::string changed_by(const TimelineChanges& changes, Eigen::Index vertex) {
  const auto count = static_cast<Eigen::Index>(changes.untouched.size());
  if (!changes.separable) {
    const double time = changes.first_change[static_cast<std::size_t>(vertex)];
    return time < 0 ? "" : fmt::format("the timeline at {:.4g} s", time);
  }
  const std::vector<TransitionField>& fields = changes.separable->fields;
  for (std::size_t k = 1; k < fields.size(); ++k) {
    if (is_changed(fields[k].change, vertex, count)) return fmt::format("\"{}\"", fields[k].name);
  }
  return "";
}

}  // namespace morphbake
