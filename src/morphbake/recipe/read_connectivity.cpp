#include <fmt/core.h>

#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

ConnectivityMode mode_of(const Json& name) {
  if (name == "remesh") return ConnectivityMode::Remesh;
  if (name == "resample") return ConnectivityMode::Resample;
  return ConnectivityMode::Shared;
}

/// Fields that say how new triangles are made mean nothing where none are made.
void complain_about_idle_fields(Reading& reading, const Json& json) {
  for (const auto& [field, value] : json.items()) {
    if (field == "mode") continue;
    complain(reading, "recipe.conflicting-fields", child_pointer("/connectivity", field),
             fmt::format("{} is for new triangles, and the mode \"shared\" makes none", field),
             "write \"mode\": \"remesh\" or \"resample\", or leave the field out");
  }
}

TextureRequest texture_of(Reading& reading, const Json& json) {
  TextureRequest texture;
  texture.of =
      look_up(reading, reading.recipe.sources, "source", json.at("of"), "/connectivity/texture/of");
  if (json.contains("size")) texture.size = whole_number(json["size"]);
  if (json.contains("padding")) texture.padding = whole_number(json["padding"]);
  return texture;
}

}  // namespace

void read_connectivity(Reading& reading) {
  const auto json = reading.document.find("connectivity");
  if (json == reading.document.end()) return;
  ConnectivityRequest& request = reading.recipe.connectivity;
  request.mode = mode_of(json->value("mode", "shared"));
  if (request.mode == ConnectivityMode::Shared) return complain_about_idle_fields(reading, *json);
  request.max_error = json->value("max_error", request.max_error);
  if (json->contains("max_vertices")) request.max_vertices = whole_number((*json)["max_vertices"]);
  request.target_edge_length = json->value("target_edge_length", request.target_edge_length);
  if (json->value("sizing", "") == "uniform") request.sizing = VertexSizing::Uniform;
  if (json->contains("texture")) request.texture = texture_of(reading, (*json)["texture"]);
}

}  // namespace morphbake
