#include "morphbake/bake/golden.h"

#include <gmock/gmock.h>

#include "morphbake/json/schema.h"

namespace morphbake {
namespace {

using testing::HasSubstr;
using testing::Not;

const Problem kProblem = {
    Severity::Error, "recipe.missing-file", {"a.json", "/sources"}, "no <such> & \"file\"", ""};

GoldenOutput output_of(GoldenVerdict verdict) {
  GoldenOutput output;
  output.name = "nose.glb";
  output.golden = "golden/nose.glb";
  output.verdict = verdict;
  return output;
}

std::vector<GoldenRecipe> every_verdict() {
  GoldenRecipe recipe;
  recipe.recipe = "a.json";
  for (const GoldenVerdict verdict : {GoldenVerdict::Same, GoldenVerdict::Different,
                                      GoldenVerdict::Missing, GoldenVerdict::Accepted}) {
    recipe.outputs.push_back(output_of(verdict));
  }
  FileDifference difference;
  difference.findings = {{true, "meshes", "mesh \"<b>\" is gone"}, {false, "name", "a note"}};
  recipe.outputs[1].difference = difference;
  recipe.outputs[1].evidence = {"evidence/nose.glb"};
  recipe.outputs.push_back(output_of(GoldenVerdict::Failed));
  recipe.outputs.back().problems = {kProblem};
  return {recipe, {"b.json", {}, {kProblem}}};
}

TEST(Golden, IsNotWhatIsDifferentMissingOrFailed) {
  for (const auto& [verdict, is_good] :
       {std::pair(GoldenVerdict::Same, true), std::pair(GoldenVerdict::Accepted, true),
        std::pair(GoldenVerdict::Different, false), std::pair(GoldenVerdict::Missing, false),
        std::pair(GoldenVerdict::Failed, false)}) {
    const std::vector<GoldenRecipe> recipes = {{"a.json", {output_of(verdict)}, {}}};
    EXPECT_EQ(is_golden(recipes), is_good);
    EXPECT_EQ(has_failed(recipes), verdict == GoldenVerdict::Failed);
  }
  EXPECT_TRUE(has_failed({{"a.json", {}, {kProblem}}}));
}

TEST(Golden, AsJsonFitsItsSchema) {
  const Json json = parse_json(golden_json(every_verdict()), "golden");
  std::string said;
  for (const Problem& problem :
       schema_problems(json, shipped_schema("golden.schema.json"), {"golden", ""})) {
    said += format_problem(problem) + "\n";
  }
  EXPECT_EQ(said, "");
  EXPECT_EQ(json["recipes"][0]["outputs"][3]["verdict"], "accepted");
}

TEST(GoldenJunit, CountsAndEscapes) {
  const std::string xml = golden_junit(every_verdict());
  EXPECT_THAT(
      xml, HasSubstr(R"(<testsuites name="morphbake golden" tests="6" failures="2" errors="2">)"));
  EXPECT_THAT(xml, HasSubstr(R"(<testsuite name="a.json" tests="5" failures="2" errors="1">)"));
  EXPECT_THAT(
      xml,
      HasSubstr("mesh &quot;&lt;b&gt;&quot; is gone [meshes]&#10;evidence: evidence/nose.glb"));
  EXPECT_THAT(xml, HasSubstr("no &lt;such&gt; &amp; &quot;file&quot;"));
  EXPECT_THAT(xml, Not(HasSubstr("a note")));
}

TEST(GoldenJunit, ReplacesWhatXmlCannotHold) {
  const auto xml_of = [](const std::string& name) { return golden_junit({{name, {}, {}}}); };
  const std::string replaced = "name=\"a\xEF\xBF\xBDz\"";
  EXPECT_THAT(xml_of("a\x01z"), HasSubstr(replaced));
  EXPECT_THAT(xml_of("a\xFFz"), HasSubstr(replaced));
  EXPECT_THAT(xml_of("a\xC0z"), HasSubstr(replaced));                 // cut off
  EXPECT_THAT(xml_of("a\xED\xA0\x80z"), Not(HasSubstr("\xED\xA0")));  // a surrogate
  EXPECT_THAT(xml_of("a\xEF\xBF\xBFz"), Not(HasSubstr("\xEF\xBF\xBF")));
  EXPECT_THAT(xml_of("a\xF0\x9F\x92\x8Ez"), HasSubstr("name=\"a\xF0\x9F\x92\x8Ez\""));
  EXPECT_THAT(xml_of("a\nz"), HasSubstr("name=\"a&#10;z\""));
}

}  // namespace
}  // namespace morphbake
