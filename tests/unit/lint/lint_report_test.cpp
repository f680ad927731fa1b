#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/schema.h"
#include "morphbake/lint/lint.h"
#include "shapes/morph_file.h"

namespace morphbake {
namespace {

/// The names of all fields in a document, or that a schema describes.
void collect(const Json& json, bool is_schema, std::set<std::string>& names) {
  for (const auto& [name, child] : json.items()) {
    if (is_schema && json.is_object() && name == "properties") {
      for (const auto& [field, node] : child.items()) names.insert(field);
    } else if (!is_schema && json.is_object()) {
      names.insert(name);
    }
    if (child.is_structured()) collect(child, is_schema, names);
  }
}

TEST(LintReport, FitsItsSchemaAndFillsAllOfIt) {
  const LintReport report = lint(test::MorphFile(9, true).open(), read_profile("spec-min"));
  const Json json = parse_json(lint_to_json(report), "report");
  const Json schema = shipped_schema("lint.schema.json");
  std::string said;
  for (const Problem& problem : schema_problems(json, schema, {"report", ""})) {
    said += format_problem(problem) + "\n";
  }
  EXPECT_EQ(said, "");
  EXPECT_EQ(json["errors"], 1);
  EXPECT_EQ(json["findings"][0]["rule"], "too-many-targets");
  std::set<std::string> written, described;
  collect(json, false, written);
  collect(schema, true, described);
  EXPECT_EQ(written, described);
}

/// The first columns of a document's tables: `code` -> the cell after it.
std::map<std::string, std::string> table_of(const std::string& document) {
  std::ifstream in(document);
  std::map<std::string, std::string> rows;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| `")) continue;
    const std::size_t end = line.find('`', 3);
    const std::size_t next = line.find("| ", end) + 2;
    rows[line.substr(3, end - 3)] = line.substr(next, line.find(" |", next) - next);
  }
  return rows;
}

TEST(LintRules, AndProfilesStandInTheDocument) {
  std::map<std::string, std::string> expected;
  for (const LintRule& rule : lint_rules()) expected[rule.code] = name_of(rule.severity);
  for (const Profile& profile : shipped_profiles()) {
    const std::string version = profile.version.empty() ? "" : " " + profile.version;
    expected[profile.name] = profile.client + version;
  }
  EXPECT_EQ(table_of(MORPHBAKE_SOURCE_DIR "/docs/profiles.md"), expected);
}

}  // namespace
}  // namespace morphbake
