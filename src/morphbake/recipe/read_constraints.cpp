
#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

void read_hold(Reading& reading) {
  const Json hold = reading.document.value("hold", Json("auto"));
  Hold& read = reading.recipe.hold;
  if (hold.is_string()) {
    read.rule = hold == "none" ? Hold::Rule::None : Hold::Rule::Auto;
    return;
  }
  read.rule = Hold::Rule::Regions;
  for (std::size_t i = 0; i < hold.size(); ++i) {
    read.regions.push_back(
        look_up(reading, reading.recipe.regions, "region", hold[i], child_pointer("/hold", i)));
  }
}

void read_point(Reading& reading, const Json& place, const std::string& pointer) {
  Gauge& gauge = reading.recipe.gauge;
  gauge.source = look_up(reading, reading.recipe.sources, "source", place["on"], pointer + "/on");
  gauge.at = read_place(reading, place["at"], gauge.source, pointer + "/at");
}

void read_gauge(Reading& reading) {
  const Json json = reading.document.value("gauge", Json("auto"));
  if (json.is_string()) return;
  Gauge& gauge = reading.recipe.gauge;
  if (json.contains("region")) {
    gauge.kind = Gauge::Kind::Region;
    gauge.region =
        look_up(reading, reading.recipe.regions, "region", json["region"], "/gauge/region");
  } else if (json.contains("landmark")) {
    gauge.kind = Gauge::Kind::Landmark;
    read_point(reading, json["landmark"], "/gauge/landmark");
  } else if (json.contains("anchor")) {
    gauge.kind = Gauge::Kind::Anchor;
    read_point(reading, json["anchor"], "/gauge/anchor");
  }
  if (reading.recipe.hold.rule != Hold::Rule::None) {
    complain(reading, "recipe.conflicting-fields", "/gauge",
             "a gauge is for surfaces that hold nothing",
             "add \"hold\": \"none\", or leave the gauge out");
  }
}

void read_representation(Reading& reading) {
  const std::string name = reading.document.value("representation", "auto");
  Recipe& recipe = reading.recipe;
  recipe.representation = representation_named(name);
  if (recipe.representation == Representation::Auto ||
      recipe.representation == Representation::Laplacian) {
    return;
  }
  if (has_shares_an_axis(recipe)) {
    complain(reading, "recipe.conflicting-fields", "/representation",
             "axes mix by themselves in the representation \"laplacian\" only",
             "give each source one share, or leave \"representation\" out");
  }
  if (recipe.gauge.kind == Gauge::Kind::Anchor) {
    complain(reading, "recipe.conflicting-fields", "/representation",
             "an anchor shows what the paper's own differences do: those of \"laplacian\"",
             "take another gauge, or leave \"representation\" out");
  }
}

}  // namespace

void read_constraints(Reading& reading) {
  read_hold(reading);
  read_gauge(reading);
  read_representation(reading);
}

}  // namespace morphbake
