#include <gtest/gtest.h>

#include <set>

#include "morphbake/bake/bake.h"
#include "morphbake/json/schema.h"

namespace morphbake {
namespace {

BakeReport full_report() {
  BakeReport report;
  report.recipe = "nose";
  report.vertices = 8;
  report.frames = 2;
  report.solve = {"warm", "as the options say",
                  6,      2,
                  1000,   {{"nose", 0, {1, 1e-12, 1e-11, true}}, {"", 0.5, {2, 0, 0, true}}}};
  report.stages = {{"solve", 0.25}};
  OutputReport output;
  output.file = "out/nose.glb";
  output.targets = {"nose"};
  output.normals = {12, 3, 0.5, 7};
  output.previews = {"out/nose.gif"};
  report.outputs = {output};
  report.problems = {
      {Severity::Warning, "export.many-targets", {"a.json", "/outputs/0"}, "many", "fewer"}};
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

}  // namespace
}  // namespace morphbake
