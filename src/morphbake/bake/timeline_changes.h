#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/transition/separate_timeline.h"

namespace morphbake {

/// How the shares change over a timeline.
struct TimelineChanges {
  Shares reference;
  std::optional<SeparableTimeline> separable;      ///< none when regions move or flood
  std::function<Eigen::MatrixXd(double time)> at;  ///< from the reference
  std::vector<bool> untouched;                     ///< #V: at the reference at all times
  std::vector<double> first_change;  ///< #V without `separable`: of a frame, or -1 for never
};

TimelineChanges changes_of_fields(SeparableTimeline separable);

/// @param separable  the timeline's fields; without them every frame is looked at
/// @return  uses the recipe and the regions
/// @throws  Cancelled
TimelineChanges changes_of(const Recipe& recipe, const RegionFields& regions, Eigen::Index count,
                           std::optional<SeparableTimeline> separable, const Observer& observer);

/// What changes a vertex's shares over the timeline, or "".
std::string changed_by(const TimelineChanges& changes, Eigen::Index vertex);

}  // namespace morphbake
