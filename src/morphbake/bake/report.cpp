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

Json to_json(const NormalReport& normals) {
  return {{"maximum", normals.maximum},
          {"percentile_99", normals.percentile_99},
          {"time", normals.time},
          {"vertex", normals.vertex}};
}

Json to_json(const OutputReport& output) {
  Json previews = Json::array();
  for (const auto& file : output.previews) previews.push_back(file.string());
  return {{"file", output.file.string()},  {"bytes", output.bytes},
          {"targets", output.targets},     {"weight_keys", output.weight_keys},
          {"max_error", output.max_error}, {"normals", to_json(output.normals)},
          {"previews", previews}};
}

Json to_json(const SolveRecord& record) {
  Json json;
  if (record.name.empty()) {
    json["time"] = record.time;
  } else {
    json["name"] = record.name;
  }
  json["iterations"] = record.convergence.iterations;
  json["residual"] = record.convergence.residual;
  json["error"] = record.convergence.error;
  return json;
}

Json to_json(const SolveReport& solve) {
  Json solves = Json::array();
  for (const SolveRecord& record : solve.solves) solves.push_back(to_json(record));
  return {{"solver", solve.solver},
          {"reason", solve.reason},
          {"unknowns", solve.unknowns},
          {"held", solve.held},
          {"factor_bytes", solve.factor_bytes},
          {"solves", std::move(solves)}};
}

}  // namespace

std::string report_to_json(const BakeReport& report) {
  Json json = {{"morphbake", version()},          {"recipe", report.recipe},
               {"vertices", report.vertices},     {"triangles", report.triangles},
               {"components", report.components}, {"frames", report.frames},
               {"solve", to_json(report.solve)}};
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
