#include <string_view>

#include "morphbake/bake/golden.h"
#include "morphbake/json/problem_json.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

std::string_view name_of(GoldenVerdict verdict) {
  switch (verdict) {
    case GoldenVerdict::Same:
      return "same";
    case GoldenVerdict::Different:
      return "different";
    case GoldenVerdict::Missing:
      return "missing";
    case GoldenVerdict::Accepted:
      return "accepted";
    case GoldenVerdict::Failed:
      break;
  }
  return "failed";
}

Json to_json(const GoldenOutput& output) {
  Json json;
  json["name"] = output.name;
  json["golden"] = output.golden.string();
  json["verdict"] = name_of(output.verdict);
  json["evidence"] = Json::array();
  for (const std::filesystem::path& file : output.evidence) {
    json["evidence"].push_back(file.string());
  }
  json["problems"] = problems_to_json(output.problems);
  if (output.difference) {
    const std::string text = difference_json(*output.difference);
    json["difference"] = parse_json(text, "difference", {.string_bytes = text.size()});
  }
  return json;
}

}  // namespace

std::string golden_json(const std::vector<GoldenRecipe>& recipes) {
  Json json;
  json["morphbake"] = version_with_commit();
  json["same"] = is_golden(recipes);
  json["recipes"] = Json::array();
  for (const GoldenRecipe& recipe : recipes) {
    Json entry;
    entry["recipe"] = recipe.recipe;
    entry["problems"] = problems_to_json(recipe.problems);
    entry["outputs"] = Json::array();
    for (const GoldenOutput& output : recipe.outputs) entry["outputs"].push_back(to_json(output));
    json["recipes"].push_back(std::move(entry));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace morphbake
