#include <fmt/core.h>

#include "morphbake/json/nearest.h"
#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

std::string unknown_landmark_hint(const SourceRef& source, const std::string& name) {
  if (!source.landmarks.empty()) {
    return name_hint(name, names_of(source.landmarks),
                     fmt::format("the landmarks of {}", source.name));
  }
  return fmt::format("{} has no landmarks: put {} beside {}, or \"landmarks\" into the source",
                     source.name, landmarks_beside(source.file).filename().string(),
                     source.file.filename().string());
}

BallRegion read_ball(Reading& reading, const Json& json, const std::string& pointer) {
  BallRegion ball;
  ball.source = look_up(reading, reading.recipe.sources, "source", json["on"], pointer + "/on");
  ball.centre = read_place(reading, json["at"], ball.source, pointer + "/at");
  ball.inner = json["inner"].get<double>();
  ball.outer = json["outer"].get<double>();
  if (json.value("distance", "") == "edges") ball.distance = DistanceMeasure::Edges;
  if (ball.inner > ball.outer) {
    complain(reading, "recipe.out-of-range", pointer + "/inner",
             fmt::format("inner is {}, more than outer, which is {}", ball.inner, ball.outer),
             "the region is full up to inner and ends at outer: swap them?");
  }
  return ball;
}

RestOfRegion read_rest_of(Reading& reading, const Json& json, const std::string& pointer) {
  RestOfRegion rest;
  for (std::size_t i = 0; i < json.size(); ++i) {
    rest.regions.push_back(
        look_up(reading, reading.recipe.regions, "region", json[i], child_pointer(pointer, i)));
  }
  return rest;
}

/// A region that is outside of itself has no meaning.
void check_cycles(Reading& reading) {
  std::vector<std::vector<int>> edges;
  for (const RegionOfInterest& region : reading.recipe.regions) {
    const auto* rest = std::get_if<RestOfRegion>(&region.shape);
    edges.push_back(rest != nullptr ? rest->regions : std::vector<int>());
  }
  for (const std::vector<int>& cycle : find_cycles(edges)) {
    std::string chain;
    for (const int region : cycle) chain += reading.recipe.regions[region].name + " -> ";
    const std::string& name = reading.recipe.regions[cycle.front()].name;
    complain(
        reading, "recipe.cycle", child_pointer("/regions", name) + "/rest_of",
        fmt::format("the region {} is the rest of itself: {}{}", shown(Json(name)), chain, name),
        "one of these regions must be given in another way");
  }
}

}  // namespace

Place read_place(Reading& reading, const Json& at, int source, const std::string& pointer) {
  if (at.is_object()) {
    return place_of(at, {reading.recipe.file.string(), pointer}, reading.problems);
  }
  if (source < 0 || !reading.landmarks_known[source]) return Eigen::Vector3d(0, 0, 0);
  const SourceRef& on = reading.recipe.sources[source];
  const auto name = at.get<std::string>();
  const int index = index_of(on.landmarks, name);
  if (index >= 0) return on.landmarks[index].at;
  complain(reading, "recipe.unknown-name", pointer,
           fmt::format("source {} has no landmark {}", shown(Json(on.name)), shown(at)),
           unknown_landmark_hint(on, name));
  return Eigen::Vector3d(0, 0, 0);
}

void read_regions(Reading& reading) {
  const Json regions = reading.document.value("regions", Json::object());
  // All names first: rest_of may name later regions.
  for (const auto& [name, region] : regions.items()) reading.recipe.regions.push_back({name, {}});
  for (RegionOfInterest& region : reading.recipe.regions) {
    const Json& json = regions[region.name];
    const std::string pointer = child_pointer("/regions", region.name);
    check_name_length(reading, region.name, pointer);
    if (json.contains("ball")) {
      region.shape = read_ball(reading, json["ball"], pointer + "/ball");
    } else if (json.contains("rest_of")) {  // else its name is misspelt, which the schema tells
      region.shape = read_rest_of(reading, json["rest_of"], pointer + "/rest_of");
    }
  }
  check_cycles(reading);
}

}  // namespace morphbake
