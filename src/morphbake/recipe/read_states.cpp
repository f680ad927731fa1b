#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

constexpr double sum_tolerance = 1e-9;

/// Shares of what one axis, or all, goes to: #shapes.
Eigen::VectorXd read_axis_shares(Reading& reading, const Json& json, const std::string& pointer) {
  if (json.is_string()) {
    return pure_share(reading, look_up(reading, reading.shapes, "source", json, pointer));
  }
  Eigen::VectorXd shares = pure_share(reading, -1);
  double sum = 0;
  bool known = true;
  for (const auto& [name, share] : json.items()) {
    const int source =
        look_up(reading, reading.shapes, "source", Json(name), child_pointer(pointer, name));
    known = known && source >= 0;
    if (source >= 0) shares(source) = share.get<double>();
    sum += share.get<double>();
  }
  if (known && std::abs(sum - 1) > sum_tolerance) {
    complain(reading, "recipe.bad-shares", pointer,
             fmt::format("the shares in {} sum to {:.10g}, not to 1", shown(json), sum),
             sum < 1 ? fmt::format("{:.10g} is missing", 1 - sum)
                     : fmt::format("{:.10g} is too much", sum - 1));
  }
  return shares;
}

void check_within(Reading& reading, double value, bool extrapolates, const char* what,
                  const std::string& pointer) {
  if (extrapolates || (value >= 0 && value <= 1)) return;
  complain(reading, "recipe.out-of-range", pointer,
           fmt::format("{} {:.10g} is not from 0 to 1", what, value),
           "\"extrapolate\": true beside it allows caricatures, which go beyond the sources");
}

void check_shares(Reading& reading, const Json& json, bool extrapolates,
                  const std::string& pointer) {
  if (json.is_string()) return;
  if (json.is_array()) {
    for (std::size_t axis = 0; axis < json.size(); ++axis) {
      check_shares(reading, json[axis], extrapolates, child_pointer(pointer, axis));
    }
    return;
  }
  for (const auto& [name, share] : json.items()) {
    check_within(reading, share.get<double>(), extrapolates, "the share",
                 child_pointer(pointer, name));
  }
}

Fit fit_of(const Json& json) {
  const auto name = json.value("fit", "");
  if (name == "rotate") return Fit::Rotate;
  return name == "similarity" ? Fit::Similarity : Fit::None;
}

/// Whether an amount is how far a flood has come.
bool may_flood(const Recipe& recipe, int region) {
  std::vector<bool> seen(recipe.regions.size(), false);
  std::vector<int> open = {region};
  while (!open.empty()) {
    const int next = open.back();
    open.pop_back();
    if (next < 0 || seen[static_cast<std::size_t>(next)]) continue;
    seen[static_cast<std::size_t>(next)] = true;
    const auto& shape = recipe.regions[static_cast<std::size_t>(next)].shape;
    if (std::holds_alternative<FloodRegion>(shape)) return true;
    const auto* combined = std::get_if<CombinedRegion>(&shape);
    if (combined == nullptr) continue;
    open.insert(open.end(), combined->regions.begin(), combined->regions.end());
  }
  return false;
}

}  // namespace

Eigen::VectorXd pure_share(const Reading& reading, int source) {
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(reading.shapes.size()));
  if (source >= 0) shares(source) = 1;
  return shares;
}

Shares read_shares(Reading& reading, const Json& json, bool extrapolates,
                   const std::string& pointer) {
  check_shares(reading, json, extrapolates, pointer);
  if (!json.is_array()) return read_axis_shares(reading, json, pointer);
  Shares shares(static_cast<Eigen::Index>(reading.shapes.size()), 3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    shares.col(static_cast<Eigen::Index>(axis)) =
        read_axis_shares(reading, json[axis], child_pointer(pointer, axis));
  }
  return shares;
}

Edit read_edit(Reading& reading, const Json& json, const std::string& pointer) {
  Edit edit;
  const bool extrapolates = json.value("extrapolate", false);
  edit.region = read_region_field(reading, json, pointer);
  edit.to = read_shares(reading, json["to"], extrapolates, pointer + "/to");
  edit.amount = json.value("amount", edit.amount);
  edit.fit = fit_of(json);
  check_within(reading, edit.amount, extrapolates, "the amount", pointer + "/amount");
  if ((edit.amount < 0 || edit.amount > 1) && may_flood(reading.recipe, edit.region)) {
    complain(reading, "recipe.out-of-range", pointer + "/amount",
             fmt::format("the amount {} of a flood is not from 0 to 1", edit.amount),
             "the amount says how far the flood comes: 1 is everywhere");
  }
  if (edit.fit != Fit::None && edit.region < 0) {
    complain(reading, "recipe.conflicting-fields", pointer + "/fit",
             "a whole surface has no ring to fit to", "name a region, or leave \"fit\" out");
  }
  if (edit.fit != Fit::None && edit.to.cols() > 1) {
    complain(reading, "recipe.conflicting-fields", pointer + "/fit",
             "shares an axis cannot be turned",
             "give one shape for all axes, or leave \"fit\" out");
  }
  return edit;
}

int state_index(Reading& reading, const Json& name, const std::string& pointer) {
  const auto wanted = name.get<std::string>();
  const int state = index_of(reading.recipe.states, wanted);
  if (state >= 0) return state;
  const std::vector<ShapeName>& sources = reading.shapes;
  const int source = index_of(sources, wanted);
  if (source >= 0) {
    reading.recipe.states.push_back({wanted, pure_share(reading, source), {}});
    return static_cast<int>(reading.recipe.states.size()) - 1;
  }
  std::vector<std::string> names = names_of(sources);
  for (const State& each : reading.recipe.states) {
    if (index_of(sources, each.name) < 0) names.push_back(each.name);
  }
  complain_unknown(reading, names, "state", name, pointer);
  return -1;
}

void read_states(Reading& reading) {
  const Json states = reading.document.value("states", Json::object());
  for (const auto& [name, json] : states.items()) {
    const std::string pointer = child_pointer("/states", name);
    check_name_length(reading, name, pointer);
    if (index_of(reading.shapes, name) >= 0) {
      complain(reading, "recipe.duplicate-name", pointer,
               fmt::format("a source is called {} as well", shown(Json(name))),
               "keys may name sources and states, so their names must differ");
    }
    const bool extrapolates = json.value("extrapolate", false);
    State state{name, read_shares(reading, json["mix"], extrapolates, pointer + "/mix"), {}};
    const Json edits = json.value("edits", Json::array());
    for (std::size_t i = 0; i < edits.size(); ++i) {
      state.edits.push_back(read_edit(reading, edits[i], child_pointer(pointer + "/edits", i)));
    }
    reading.recipe.states.push_back(std::move(state));
  }
}

}  // namespace morphbake
