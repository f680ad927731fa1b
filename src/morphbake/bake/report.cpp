#include "morphbake/bake/bake.h"
#include "morphbake/bake/remesh.h"
#include "morphbake/json/problem_json.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

Json to_json(const NormalReport& normals) {
  return {{"maximum", normals.maximum},
          {"percentile_99", normals.percentile_99},
          {"time", normals.time},
          {"vertex", normals.vertex}};
}

Json to_json(const OutputReport& output) {
  Json previews = Json::array();
  for (const auto& file : output.previews) previews.push_back(file.string());
  return {{"file", output.file.string()},
          {"bytes", output.bytes},
          {"kind", output.kind},
          {"targets", output.targets},
          {"weight_keys", output.weight_keys},
          {"max_error", output.max_error},
          {"worst", {{"time", output.worst_time}, {"vertex", output.worst_vertex}}},
          {"normals", to_json(output.normals)},
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
  return {{"representation", solve.representation},
          {"representation_reason", solve.representation_reason},
          {"solver", solve.solver},
          {"reason", solve.reason},
          {"unknowns", solve.unknowns},
          {"held", solve.held},
          {"factor_bytes", solve.factor_bytes},
          {"solves", std::move(solves)}};
}

Json to_json(const std::vector<StageReport>& stages) {
  Json list = Json::array();
  for (const StageReport& stage : stages) {
    list.push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  }
  return list;
}

const char* name_of(ConnectivityMode mode) {
  if (mode == ConnectivityMode::Remesh) return "remesh";
  return mode == ConnectivityMode::Resample ? "resample" : "shared";
}

Json to_json(const SourceQuality& quality) {
  Json json = {{"source", quality.source},
               {"source_to_remesh", quality.source_to_remesh},
               {"remesh_to_source", quality.remesh_to_source},
               {"folds", quality.folds},
               {"self_intersections", quality.self_intersections},
               {"source_self_intersections", quality.source_self_intersections},
               {"new_self_intersections", quality.new_self_intersections},
               {"smallest_angle", quality.smallest_angle},
               {"longest_edge", quality.longest_edge},
               {"landmark_error", quality.landmark_error}};
  if (quality.sphere) {
    json["sphere"] = {{"flipped_triangles", quality.sphere->flipped_triangles},
                      {"covering", quality.sphere->covering}};
  }
  return json;
}

Json to_json(const MapQuality& map) {
  return {{"source", map.source},
          {"mean", map.mean},
          {"median", map.median},
          {"percentile_95", map.percentile_95},
          {"percentile_99", map.percentile_99},
          {"maximum", map.maximum}};
}

Json to_json(const DistortionRegion& region, const std::string& first) {
  Json json = {{"source", region.source},
               {"triangles", region.triangles},
               {"area_share", region.area_share},
               {"centre", {region.centre(0), region.centre(1), region.centre(2)}}};
  if (!region.nearest_landmark.empty()) {
    json["nearest_landmark"] = region.nearest_landmark;
    json["landmark_distance"] = region.landmark_distance;
  }
  json["advice"] = advice_for(region, first);
  return json;
}

Json to_json(const SourceRepairs& mended) {
  return {{"source", mended.source},
          {"degenerate", mended.repairs.degenerate},
          {"duplicate", mended.repairs.duplicate},
          {"turned", mended.repairs.turned}};
}

template <typename Item>
Json list_of(const std::vector<Item>& items) {
  Json list = Json::array();
  for (const Item& item : items) list.push_back(to_json(item));
  return list;
}

Json to_json(const ConnectivityReport& report) {
  Json json = {{"mode", name_of(report.mode)},
               {"vertices", report.vertices},
               {"triangles", report.triangles},
               {"repairs", list_of(report.repairs)}};
  if (report.mode == ConnectivityMode::Shared) return json;
  json["steps"] = to_json(report.steps);
  if (report.texture) {
    json["texture"] = {{"size", report.texture->size},
                       {"charts", report.texture->charts},
                       {"covered", report.texture->covered}};
  }
  if (!report.quality) return json;
  json["sources"] = list_of(report.quality->sources);
  json["distortion"] = list_of(report.quality->maps);
  const std::string& first = report.quality->sources.front().source;
  json["distorted_regions"] = Json::array();
  for (const DistortionRegion& region : report.quality->regions) {
    json["distorted_regions"].push_back(to_json(region, first));
  }
  return json;
}

}  // namespace

std::string report_to_json(const BakeReport& report) {
  Json json = {{"morphbake", version_with_commit()},
               {"recipe", report.recipe},
               {"vertices", report.vertices},
               {"triangles", report.triangles},
               {"components", report.components},
               {"frames", report.frames},
               {"connectivity", to_json(report.connectivity)},
               {"solve", to_json(report.solve)}};
  json["stages"] = to_json(report.stages);
  json["cached"] = report.cached;
  json["outputs"] = list_of(report.outputs);
  json["problems"] = problems_to_json(report.problems);
  return json.dump(2) + "\n";
}

std::string report_to_json(const RemeshReport& report) {
  Json json = {{"morphbake", version_with_commit()},
               {"recipe", report.recipe},
               {"connectivity", to_json(report.connectivity)}};
  json["files"] = Json::array();
  for (const auto& file : report.files) json["files"].push_back(file.string());
  json["problems"] = problems_to_json(report.problems);
  return json.dump(2) + "\n";
}

}  // namespace morphbake
