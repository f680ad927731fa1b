#include "morphbake/bake/options.h"

#include <gtest/gtest.h>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/schema.h"

namespace morphbake {
namespace {

std::string problems_of(const std::string& recipe_options,
                        const std::vector<std::string>& settings) {
  try {
    read_options(recipe_options, "recipe.json", settings);
  } catch (const BakeError& error) {
    return error.what();
  }
  return "";
}

Json defaults() { return parse_json(options_to_json({}), "defaults"); }

TEST(Options, DefaultsAreThoseOfTheShippedFile) {
  Json shipped = read_json(MORPHBAKE_SOURCE_DIR "/config/bake.json", "bake.json");
  EXPECT_EQ(shipped["$schema"], "../schemas/options.schema.json");
  shipped.erase("$schema");
  EXPECT_EQ(shipped.dump(2), defaults().dump(2));
}

TEST(Options, DefaultsAreThoseOfTheSchema) {
  const Json schema = shipped_schema("options.schema.json");
  Json from_schema;
  for (const auto& [stage, node] : schema["properties"].items()) {
    if (stage == "$schema") continue;
    for (const auto& [field, option] : node["properties"].items()) {
      from_schema[stage][field] = option["default"];
    }
  }
  EXPECT_EQ(from_schema, defaults());
}

TEST(Options, DefaultsAreValid) {
  EXPECT_TRUE(
      schema_problems(defaults(), shipped_schema("options.schema.json"), {"defaults", ""}).empty());
}

TEST(Options, EachLayerOverridesTheOneBefore) {
  const BakeOptions options = read_options(
      R"({"basis": {"easing_tolerance": 1e-5}, "turntable": {"samples": 4.0, "fill": 0.8}})",
      "recipe.json", {"/turntable/samples=9", "/turntable/samples=10"});
  EXPECT_EQ(options.basis.easing_tolerance, 1e-5);
  EXPECT_EQ(options.turntable.samples, 10);
  EXPECT_EQ(options.turntable.fill, 0.8);
  EXPECT_EQ(options.turntable.orbit, TurntableOptions{}.orbit);
}

TEST(Options, AllProblemsAreReported) {
  const std::string said = problems_of(R"({"basis": {"easing_tolerance": 1}})",
                                       {"/turntable/sampels=9", "/turntable/samples=many",
                                        "nothing", "/turntable/fill=2", "/basis=1"});
  for (
      const char* expected :
      {"recipe.json#/options/basis/easing_tolerance: error: easing_tolerance must be a number from "
       "1e-12 to 0.1 (fraction of the bounding-box diagonal), not 1 [options.out-of-range]",
       "--set: error: there is no option \"/turntable/sampels\" [options.unknown-field]\n"
       "  hint: did you mean \"/turntable/samples\"? options are: /solve/solver, ",
       "--set#/turntable/samples: error: samples must be a whole number from 1 to 1024 (rays), not "
       "\"many\" [options.wrong-type]",
       "--set: error: \"nothing\" sets nothing [options.bad-setting]\n"
       "  hint: write for example --set /basis/easing_tolerance=1e-7",
       "--set#/turntable/fill: error: fill must be a number from 0.6 to 0.85 (share of the "
       "picture), not 2 [options.out-of-range]",
       "--set: error: there is no option \"/basis\" [options.unknown-field]"}) {
    EXPECT_NE(said.find(expected), std::string::npos) << expected << "\nsaid: " << said;
  }
}

}  // namespace
}  // namespace morphbake
