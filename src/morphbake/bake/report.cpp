#include "morphbake/bake/bake.h"
#include "morphbake/json/json.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

Json to_json(const Problem& problem) {
  return {{"severity", problem.severity == Severity::Error ? "error" : "warning"},
          {"code", problem.code},
          {"file", problem.location.file},
          {"pointer", problem.location.pointer},
          {"message", problem.message},
          {"hint", problem.hint}};
}

Json to_json(const OutputReport& output) {
  Json previews = Json::array();
  for (const auto& file : output.previews) previews.push_back(file.string());
  return {{"file", output.file.string()},  {"bytes", output.bytes},
          {"targets", output.targets},     {"weight_keys", output.weight_keys},
          {"max_error", output.max_error}, {"max_normal_error", output.max_normal_error},
          {"previews", previews}};
}

}  // namespace

std::string report_to_json(const BakeReport& report) {
  Json json = {{"morphbake", version()},
               {"recipe", report.recipe},
               {"vertices", report.vertices},
               {"triangles", report.triangles},
               {"components", report.components},
               {"frames", report.frames},
               {"solved_shapes", report.solved_shapes}};
  json["stages"] = Json::array();
  for (const StageReport& stage : report.stages) {
    json["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  }
  json["outputs"] = Json::array();
  for (const OutputReport& output : report.outputs) json["outputs"].push_back(to_json(output));
  json["problems"] = Json::array();
  for (const Problem& problem : report.problems) json["problems"].push_back(to_json(problem));
  return json.dump(2) + "\n";
}

}  // namespace morphbake
