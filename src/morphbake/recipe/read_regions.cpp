#include "morphbake/recipe/read_regions.h"

#include <fmt/core.h>

#include <utility>

#include "morphbake/json/nearest.h"

namespace morphbake {
namespace {

/// The ways in which a region may be given.
const std::vector<const char*> kKinds = {"ball",       "rings",  "mask",   "scattered",
                                         "spatial",    "flood",  "union",  "intersection",
                                         "difference", "invert", "rest_of"};

std::string unknown_landmark_hint(const SourceRef& source, const std::string& name) {
  if (!source.landmarks.empty()) {
    return name_hint(name, names_of(source.landmarks),
                     fmt::format("the landmarks of {}", source.name));
  }
  return fmt::format("{} has no landmarks: put {} beside {}, or \"landmarks\" into the source",
                     source.name, landmarks_beside(source.file).filename().string(),
                     source.file.filename().string());
}

int read_on(Reading& reading, const Json& json, const std::string& pointer) {
  return look_up(reading, reading.recipe.sources, "source", json["on"], pointer + "/on");
}

DistanceMeasure measure_of(const Json& json) {
  const auto name = json.value("distance", "");
  if (name == "edges") return DistanceMeasure::Edges;
  return name == "hops" ? DistanceMeasure::Hops : DistanceMeasure::Geodesic;
}

std::vector<Place> read_places(Reading& reading, const Json& json, int source,
                               const std::string& pointer) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < json.size(); ++i) {
    places.push_back(read_place(reading, json[i], source, child_pointer(pointer, i)));
  }
  return places;
}

BallRegion read_ball(Reading& reading, const Json& json, const std::string& pointer) {
  BallRegion ball;
  ball.source = read_on(reading, json, pointer);
  ball.centre = read_place(reading, json["at"], ball.source, pointer + "/at");
  ball.inner = json["inner"].get<double>();
  ball.outer = json["outer"].get<double>();
  ball.distance = measure_of(json);
  if (ball.inner > ball.outer) {
    complain(reading, "recipe.out-of-range", pointer + "/inner",
             fmt::format("inner is {}, more than outer, which is {}", ball.inner, ball.outer),
             "the region is full up to inner and ends at outer: swap them?");
  }
  return ball;
}

RingsRegion read_rings(Reading& reading, const Json& json, const std::string& pointer) {
  RingsRegion rings;
  rings.source = read_on(reading, json, pointer);
  rings.inner = read_places(reading, json["inner"], rings.source, pointer + "/inner");
  rings.outer = read_places(reading, json["outer"], rings.source, pointer + "/outer");
  rings.distance = measure_of(json);
  return rings;
}

MaskRegion read_mask(Reading& reading, const Json& json, const std::string& pointer) {
  check_one_of(reading, json, {"attribute", "material", "primitive", "image"}, "kind of mask",
               pointer);
  MaskRegion mask;
  mask.source = read_on(reading, json, pointer);
  if (json.contains("attribute")) {
    mask.by = AttributeMask{json["attribute"].get<std::string>(), whole_number(json, "channel")};
  } else if (json.contains("material")) {
    mask.by = MaterialMask{name_or_index(json, "material")};
  } else if (json.contains("primitive")) {
    mask.by = PrimitiveMask{whole_number(json, "primitive")};
  } else if (json.contains("image")) {
    mask.by = ImageMask{existing_file(reading, json["image"], pointer + "/image"),
                        whole_number(json, "texcoord")};
  }
  return mask;
}

ScatteredRegion read_scattered(Reading& reading, const Json& json, const std::string& pointer) {
  ScatteredRegion scattered;
  scattered.source = read_on(reading, json, pointer);
  for (const auto& [name, value] : json["values"].items()) {
    const std::string at = child_pointer(pointer + "/values", name);
    scattered.values.push_back(
        {name, read_place(reading, Json(name), scattered.source, at), value.get<double>()});
  }
  return scattered;
}

FloodRegion read_flood(Reading& reading, const Json& json, const std::string& pointer) {
  FloodRegion flood;
  flood.source = read_on(reading, json, pointer);
  flood.seeds = read_places(reading, json["from"], flood.source, pointer + "/from");
  flood.distance = measure_of(json);
  flood.softness = json.value("softness", 0.1);
  return flood;
}

CombinedRegion read_combined(Reading& reading, CombinedRegion::Kind kind, const Json& names,
                             const std::string& pointer) {
  CombinedRegion combined{kind, {}};
  const auto add = [&](const Json& name, const std::string& at) {
    combined.regions.push_back(look_up(reading, reading.recipe.regions, "region", name, at));
  };
  if (names.is_string()) add(names, pointer);
  for (std::size_t i = 0; names.is_array() && i < names.size(); ++i) {
    add(names[i], child_pointer(pointer, i));
  }
  return combined;
}

/// A region that is made of itself has no meaning.
void check_cycles(Reading& reading) {
  std::vector<std::vector<int>> edges;
  for (const RegionOfInterest& region : reading.recipe.regions) {
    const auto* combined = std::get_if<CombinedRegion>(&region.shape);
    edges.push_back(combined != nullptr ? combined->regions : std::vector<int>());
  }
  for (const std::vector<int>& cycle : find_cycles(edges)) {
    std::string chain;
    for (const int region : cycle) chain += reading.recipe.regions[region].name + " -> ";
    const std::string& name = reading.recipe.regions[cycle.front()].name;
    const std::string pointer = child_pointer("/regions", name);
    complain(reading, "recipe.cycle", pointer + "/" + kind_of(reading.document["regions"][name]),
             fmt::format("the region {} is made of itself: {}{}", shown(Json(name)), chain, name),
             "one of these regions must be given in another way");
  }
}

}  // namespace

std::string kind_of(const Json& region) {
  for (const char* kind : kKinds) {
    if (region.contains(kind)) return kind;
  }
  return "";
}

Place read_place(Reading& reading, const Json& at, int source, const std::string& pointer) {
  if (at.is_object()) {
    return place_of(at, location_in(reading.recipe, pointer), reading.problems);
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

namespace {

void read_shape(Reading& reading, const Json& json, const std::string& pointer,
                RegionOfInterest& region) {
  using Kind = CombinedRegion::Kind;
  const std::string kind = kind_of(json);
  if (kind.empty()) return;  // its name is misspelt, which the schema tells, or missing
  const Json& of = json[kind];
  const std::string at = pointer + "/" + kind;
  if (kind == "ball") region.shape = read_ball(reading, of, at);
  if (kind == "rings") region.shape = read_rings(reading, of, at);
  if (kind == "mask") region.shape = read_mask(reading, of, at);
  if (kind == "scattered") region.shape = read_scattered(reading, of, at);
  if (kind == "spatial") region.shape = read_spatial(reading, of, at);
  if (kind == "flood") region.shape = read_flood(reading, of, at);
  if (kind == "union") region.shape = read_combined(reading, Kind::Union, of, at);
  if (kind == "intersection") region.shape = read_combined(reading, Kind::Intersection, of, at);
  if (kind == "difference") region.shape = read_combined(reading, Kind::Difference, of, at);
  if (kind == "invert" || kind == "rest_of") {
    region.shape = read_combined(reading, Kind::RestOf, of, at);
  }
}

Falloff falloff_of(const Json& json) {
  const auto name = json.value("falloff", "");
  if (name == "smoothstep") return Falloff::Smoothstep;
  return name == "cosine" ? Falloff::Cosine : Falloff::Linear;
}

}  // namespace

void read_regions(Reading& reading) {
  const Json regions = reading.document.value("regions", Json::object());
  // All names first: regions may name later ones.
  for (const auto& [name, region] : regions.items()) reading.recipe.regions.push_back({name, {}});
  for (RegionOfInterest& region : reading.recipe.regions) {
    const Json& json = regions[region.name];
    const std::string pointer = child_pointer("/regions", region.name);
    check_name_length(reading, region.name, pointer);
    check_one_of(reading, json, kKinds, "kind of region", pointer);
    read_shape(reading, json, pointer, region);
    region.falloff = falloff_of(json);
  }
  check_cycles(reading);
}

}  // namespace morphbake
