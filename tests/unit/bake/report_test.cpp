#include <gtest/gtest.h>

#include <set>

#include "morphbake/bake/bake.h"
#include "morphbake/bake/remesh.h"
#include "morphbake/json/schema.h"

namespace morphbake {
namespace {

ConnectivityReport full_connectivity() {
  TriangulationQuality quality;
  quality.sources.push_back({"a", 0.001, 0.002, 1, 3, 3, 0, 20, 0.05, 0, SphereQuality{}});
  quality.maps.push_back({"b", 1.2, 1.1, 1.5, 2, 7});
  quality.regions.push_back({"b", 4, 0.01, 0.02, {1, 2, 3}, "tip", 0.1, true, {4, 5, 6}, 0.2});
  return {ConnectivityMode::Remesh,    8,      12, {{"a", {1, 2, 3}}}, {{"sphere", 0.5}},
          TextureReport{1024, 3, 0.5}, quality};
}

SharedTriangulation of_vertices(int count, bool is_full = false) {
  SharedTriangulation triangulation;
  triangulation.connectivity.vertex_count = count;
  triangulation.is_full = is_full;
  return triangulation;
}

BakeReport full_report() {
  BakeReport report;
  report.recipe = "nose";
  report.vertices = 8;
  report.frames = 2;
  report.solve = {"laplacian", "as the recipe says",
                  "warm",      "as the options say",
                  6,           2,
                  1000,        {{"nose", 0, {1, 1e-12, 1e-11, true}}, {"", 0.5, {2, 0, 0, true}}}};
  report.stages = {{"solve", 0.25}};
  report.connectivity = full_connectivity();
  OutputReport output;
  output.file = "out/nose.glb";
  output.kind = "tracks";
  output.targets = {"nose"};
  output.normals = {12, 3, 0.5, 7};
  output.previews = {"out/nose.gif"};
  report.outputs = {output};
  report.problems = {
      {Severity::Warning, "export.many-targets", {"a.csv", "/outputs/0", 3, 2}, "many", "fewer"}};
  return report;
}

/// All names of fields below `node`, of a document or of a schema's properties.
void collect(const Json& node, bool is_schema, std::set<std::string>& names) {
  if (node.is_array()) {
    for (const Json& child : node) collect(child, is_schema, names);
    return;
  }
  if (!node.is_object()) return;
  for (const auto& [key, child] : node.items()) {
    if (!is_schema) names.insert(key);
    if (is_schema && key == "properties") {
      for (const auto& [name, field] : child.items()) {
        names.insert(name);
        collect(field, true, names);
      }
    } else {
      collect(child, is_schema, names);
    }
  }
}

TEST(Report, FitsItsSchemaAndFillsAllOfIt) {
  const Json report = parse_json(report_to_json(full_report()), "report");
  const Json schema = shipped_schema("report.schema.json");
  std::string said;
  for (const Problem& problem : schema_problems(report, schema, {"report", ""})) {
    said += format_problem(problem) + "\n";
  }
  EXPECT_EQ(said, "");
  std::set<std::string> written, described;
  collect(report, false, written);
  collect(schema, true, described);
  EXPECT_EQ(written, described);
}

TEST(Report, OfRemeshingFitsItsSchema) {
  RemeshReport remeshed{"nose", full_connectivity(), {"out/a.glb"}, full_report().problems};
  const Json report = parse_json(report_to_json(remeshed), "report");
  const Json schema = shipped_schema("remesh-report.schema.json");
  EXPECT_TRUE(schema_problems(report, schema, {"report", ""}).empty());
  EXPECT_NE(report["connectivity"]["distorted_regions"][0]["advice"].get<std::string>().find(
                "add a landmark on every source; the region ends near (4, 5, 6) on \"b\", 0.2 "),
            std::string::npos);
}

TEST(Report, OfASharedConnectivityTellsItsSizeAndRepairsOnly) {
  BakeReport report = full_report();
  report.connectivity = {ConnectivityMode::Shared, 8, 12, {}, {}, {}, {}};
  const Json json = parse_json(report_to_json(report), "report");
  EXPECT_EQ(
      json["connectivity"],
      Json({{"mode", "shared"}, {"vertices", 8}, {"triangles", 12}, {"repairs", Json::array()}}));
}

TEST(ConnectivityWarnings, NameWhatIsWorthALook) {
  const std::vector<Problem> warnings =
      connectivity_warnings(Recipe{}, of_vertices(100), *full_connectivity().quality);
  std::vector<std::string> codes;
  for (const Problem& warning : warnings) codes.push_back(warning.code);
  EXPECT_EQ(codes,
            (std::vector<std::string>{"connectivity.folds", "connectivity.high-distortion"}));
}

TEST(ConnectivityWarnings, PassOverRegionsThatNobodySees) {
  TriangulationQuality quality = *full_connectivity().quality;
  quality.regions[0].area_share = 0;
  quality.regions[0].other_area_share = 0.0009;
  for (const Problem& warning : connectivity_warnings(Recipe{}, of_vertices(100), quality)) {
    EXPECT_NE(warning.code, "connectivity.high-distortion");
  }
}

TEST(ConnectivityWarnings, TellWhatTheLimitOfVerticesLeftUndone) {
  Recipe recipe;
  recipe.connectivity.max_vertices = 100;
  TriangulationQuality quality;
  quality.sources.emplace_back().source = "cow";
  quality.sources[0].source_to_remesh = 0.01;
  quality.sources[0].longest_edge = 0.3;
  std::vector<Problem> warnings = connectivity_warnings(recipe, of_vertices(98, true), quality);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].code, "connectivity.error-not-reached");
  EXPECT_EQ(warnings[0].message,
            "\"cow\" is met within 0.01 of its diagonal, not within max_error (0.002); refinement "
            "ended at max_vertices (100)");
  EXPECT_EQ(warnings[1].code, "connectivity.edge-length-not-reached");
  warnings = connectivity_warnings(recipe, of_vertices(98), quality);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].message.find("max_vertices"), std::string::npos);
}

TEST(ConnectivityWarnings, SayNothingOfAnErrorThatAUniformResampleWasNotAskedFor) {
  Recipe recipe;
  recipe.connectivity.mode = ConnectivityMode::Resample;
  TriangulationQuality quality;
  quality.sources.emplace_back().source_to_remesh = 0.01;
  EXPECT_EQ(connectivity_warnings(recipe, of_vertices(100), quality).size(), 1U);
  recipe.connectivity.sizing = VertexSizing::Uniform;
  EXPECT_TRUE(connectivity_warnings(recipe, of_vertices(100), quality).empty());
  recipe.connectivity.mode = ConnectivityMode::Remesh;
  EXPECT_EQ(connectivity_warnings(recipe, of_vertices(100), quality).size(), 1U);
}

}  // namespace
}  // namespace morphbake
