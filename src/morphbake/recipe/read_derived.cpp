#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

const std::vector<const char*> kWays = {"file", "band", "edit", "mirror", "transform"};

std::string way_of(const Json& source) {
  for (const char* way : kWays) {
    if (source.contains(way)) return way;
  }
  return "";
}

Eigen::Vector3d vector_of(const Json& owner, const char* field, const Eigen::Vector3d& otherwise) {
  if (!owner.contains(field)) return otherwise;
  const Json& json = owner[field];
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

Eigen::Vector3d read_direction(Reading& reading, const Json& owner, const std::string& pointer,
                               const char* field, const Eigen::Vector3d& otherwise) {
  const Eigen::Vector3d direction = vector_of(owner, field, otherwise);
  if (direction.isZero(0)) {
    complain(reading, "recipe.out-of-range", child_pointer(pointer, field),
             "(0, 0, 0) is no direction", "give for example [1, 0, 0]");
  }
  return direction;
}

Movement read_movement(Reading& reading, const Json& json, const std::string& pointer) {
  Movement movement;
  movement.translate = vector_of(json, "translate", movement.translate);
  if (json.contains("scale")) {
    const Json& scale = json["scale"];
    movement.scale = scale.is_object() ? scale["factor"].get<double>() : scale.get<double>();
    if (scale.is_object()) {
      movement.scale_along =
          read_direction(reading, scale, pointer + "/scale", "along", Eigen::Vector3d::UnitY());
    }
  }
  if (json.contains("rotate")) {
    const Json& rotate = json["rotate"];
    movement.axis = read_direction(reading, rotate, pointer + "/rotate", "axis", movement.axis);
    movement.degrees = rotate["degrees"].get<double>();
  }
  return movement;
}

HandleTarget read_target(Reading& reading, const Json& json, int root, const std::string& pointer) {
  if (json.is_array()) {
    return {root,
            Eigen::Vector3d(json[0].get<double>(), json[1].get<double>(), json[2].get<double>())};
  }
  HandleTarget target;
  target.source = look_up(reading, reading.recipe.sources, "source", json["on"], pointer + "/on");
  target.at = read_place(reading, json["at"], target.source, pointer + "/at");
  return target;
}

EditHandle read_handle(Reading& reading, const Json& json, int root, const std::string& pointer) {
  check_one_of(reading, json, {"region", "at"}, "place for the handle", pointer);
  EditHandle handle;
  handle.region = read_region_field(reading, json, pointer);
  if (json.contains("at")) handle.at = read_place(reading, json["at"], root, pointer + "/at");
  const bool moves =
      json.contains("translate") || json.contains("rotate") || json.contains("scale");
  if (json.contains("to") == moves) {
    complain(reading, moves ? "recipe.conflicting-fields" : "recipe.missing-field", pointer,
             moves ? "\"to\" excludes \"translate\", \"rotate\" and \"scale\""
                   : "where does this handle go?",
             moves ? "give one of them"
                   : "give \"to\", or a movement; \"translate\": [0, 0, 0] holds it where it is");
  }
  if (json.contains("to")) {
    handle.to = read_target(reading, json["to"], root, pointer + "/to");
    if (handle.region >= 0) {
      complain(reading, "recipe.conflicting-fields", pointer + "/to",
               "a region cannot go to one point",
               "move it by \"translate\", or name a point in \"at\"");
    }
  } else {
    handle.to = read_movement(reading, json, pointer);
  }
  return handle;
}

EditSource read_edit_source(Reading& reading, const Json& json, int root,
                            const std::string& pointer) {
  EditSource edit;
  edit.region = read_region_field(reading, json, pointer);
  edit.turns = json.value("representation", "laplacian") == "rotation";
  const Json& handles = json["handles"];
  for (std::size_t i = 0; i < handles.size(); ++i) {
    edit.handles.push_back(
        read_handle(reading, handles[i], root, child_pointer(pointer + "/handles", i)));
  }
  return edit;
}

BandSource read_band(Reading& reading, const Json& json, const std::string& pointer) {
  BandSource band;
  band.first = whole_number(json, "first");
  if (json.contains("last")) band.last = whole_number(json, "last");
  if (band.last && *band.last < band.first) {
    complain(reading, "recipe.out-of-range", pointer + "/last",
             fmt::format("the band ends at {}, before it begins at {}", *band.last, band.first),
             "swap them?");
  }
  return band;
}

MirrorSource read_mirror(Reading& reading, const Json& json, const std::string& pointer) {
  MirrorSource mirror;
  mirror.normal = read_direction(reading, json, pointer, "normal", mirror.normal);
  mirror.offset = json.value("offset", 0.0);
  if (json.contains("symmetric")) {
    mirror.symmetric =
        look_up(reading, reading.shapes, "source", json["symmetric"], pointer + "/symmetric");
  }
  return mirror;
}

void read_how(Reading& reading, const Json& source, DerivedSource& derived) {
  const std::string way = way_of(source);
  const std::string pointer = child_pointer("/sources", derived.name) + "/" + way;
  const Json& json = source[way];
  if (way == "band") derived.how = read_band(reading, json, pointer);
  if (way == "edit") derived.how = read_edit_source(reading, json, derived.root, pointer);
  if (way == "mirror") derived.how = read_mirror(reading, json, pointer);
  if (way == "transform") derived.how = TransformSource{read_movement(reading, json, pointer)};
}

/// The shapes that each derived one is made from, by their numbers among the derived.
std::vector<std::vector<int>> needs_of(const std::vector<std::string>& names, const Json& sources) {
  std::vector<std::vector<int>> needs(names.size());
  for (std::size_t d = 0; d < names.size(); ++d) {
    const Json& json = sources[names[d]][way_of(sources[names[d]])];
    for (const char* field : {"of", "symmetric"}) {
      if (!json.contains(field)) continue;
      const auto found = std::find(names.begin(), names.end(), json[field].get<std::string>());
      if (found != names.end()) needs[d].push_back(static_cast<int>(found - names.begin()));
    }
  }
  return needs;
}

void add_in_order(int node, const std::vector<std::vector<int>>& needs, std::vector<bool>& done,
                  std::vector<int>& order) {
  if (done[static_cast<std::size_t>(node)]) return;
  done[static_cast<std::size_t>(node)] = true;
  for (const int need : needs[static_cast<std::size_t>(node)]) {
    add_in_order(need, needs, done, order);
  }
  order.push_back(node);
}

bool complain_of_cycles(Reading& reading, const std::vector<std::string>& names,
                        const std::vector<std::vector<int>>& needs) {
  const auto cycles = find_cycles(needs);
  for (const std::vector<int>& cycle : cycles) {
    std::string chain;
    for (const int node : cycle) chain += names[static_cast<std::size_t>(node)] + " -> ";
    const std::string& first = names[static_cast<std::size_t>(cycle.front())];
    complain(
        reading, "recipe.cycle", child_pointer("/sources", first),
        fmt::format("the source {} is derived from itself: {}{}", shown(Json(first)), chain, first),
        "one of these sources must have a file");
  }
  return !cycles.empty();
}

}  // namespace

bool is_derived(Reading& reading, const Json& source, const std::string& pointer) {
  if (source.is_string()) return false;
  check_one_of(reading, source, kWays, "way to get the source", pointer);
  const std::string way = way_of(source);
  return !way.empty() && way != "file";
}

void name_derived(Reading& reading, const std::vector<std::string>& names) {
  const Json& sources = reading.document["sources"];
  const auto needs = needs_of(names, sources);
  if (complain_of_cycles(reading, names, needs)) return;
  std::vector<bool> done(names.size(), false);
  std::vector<int> order;
  for (int d = 0; d < static_cast<int>(names.size()); ++d) add_in_order(d, needs, done, order);
  for (const int d : order) {
    const std::string& name = names[static_cast<std::size_t>(d)];
    const std::string way = way_of(sources[name]);
    DerivedSource derived;
    derived.name = name;
    derived.of = look_up(reading, reading.shapes, "source", sources[name][way]["of"],
                         child_pointer("/sources", name) + "/" + way + "/of");
    const auto files = static_cast<int>(reading.recipe.sources.size());
    derived.root = derived.of < files
                       ? std::max(derived.of, 0)
                       : reading.recipe.derived[static_cast<std::size_t>(derived.of - files)].root;
    reading.recipe.derived.push_back(derived);
    reading.shapes.push_back({name});
  }
}

void read_derived(Reading& reading) {
  for (DerivedSource& derived : reading.recipe.derived) {
    read_how(reading, reading.document["sources"][derived.name], derived);
  }
}

}  // namespace morphbake
