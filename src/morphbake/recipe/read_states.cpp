#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

constexpr double sum_tolerance = 1e-9;

Shares pure_share(const Reading& reading, int source) {
  Shares shares(reading.recipe.sources.size(), 0.0);
  if (source >= 0) shares[source] = 1;
  return shares;
}

Edit read_edit(Reading& reading, const Json& json, const std::string& pointer) {
  Edit edit;
  edit.region = read_region_field(reading, json, pointer);
  edit.to = read_shares(reading, json["to"], pointer + "/to");
  edit.amount = json.value("amount", edit.amount);
  return edit;
}

}  // namespace

Shares read_shares(Reading& reading, const Json& json, const std::string& pointer) {
  const std::vector<SourceRef>& sources = reading.recipe.sources;
  if (json.is_string()) {
    return pure_share(reading, look_up(reading, sources, "source", json, pointer));
  }
  Shares shares = pure_share(reading, -1);
  double sum = 0;
  bool known = true;
  for (const auto& [name, share] : json.items()) {
    const int source =
        look_up(reading, sources, "source", Json(name), child_pointer(pointer, name));
    known = known && source >= 0;
    if (source >= 0) shares[source] = share.get<double>();
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

int state_index(Reading& reading, const Json& name, const std::string& pointer) {
  const auto wanted = name.get<std::string>();
  const int state = index_of(reading.recipe.states, wanted);
  if (state >= 0) return state;
  const std::vector<SourceRef>& sources = reading.recipe.sources;
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
    if (index_of(reading.recipe.sources, name) >= 0) {
      complain(reading, "recipe.duplicate-name", pointer,
               fmt::format("a source is called {} as well", shown(Json(name))),
               "keys may name sources and states, so their names must differ");
    }
    State state{name, read_shares(reading, json["mix"], pointer + "/mix"), {}};
    const Json edits = json.value("edits", Json::array());
    for (std::size_t i = 0; i < edits.size(); ++i) {
      state.edits.push_back(read_edit(reading, edits[i], child_pointer(pointer + "/edits", i)));
    }
    reading.recipe.states.push_back(std::move(state));
  }
}

}  // namespace morphbake
