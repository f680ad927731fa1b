#include "morphbake/profile/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/embedded.h"
#include "morphbake/json/schema.h"

namespace morphbake {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kFolder = MORPHBAKE_SOURCE_DIR "/config/profiles/";

std::string said_of(const std::string& name_or_file) {
  try {
    read_profile(name_or_file);
  } catch (const BakeError& error) {
    return error.what();
  }
  return "";
}

/// What is said of a file with that text.
std::string said_of_text(const std::string& text) {
  const std::string file = testing::TempDir() + "profile_test.json";
  std::ofstream(file) << text;
  const std::string said = said_of(file);
  std::filesystem::remove(file);
  return said;
}

TEST(Profile, OfAnUnknownNameTellsTheNearest) {
  const std::string said = said_of("web-tree");
  EXPECT_THAT(said, HasSubstr("there is no profile \"web-tree\" [profile.unknown-name]"));
  EXPECT_THAT(said, HasSubstr("did you mean \"web-three\"? profiles are: archive, babylon,"));
  EXPECT_THAT(said, HasSubstr("the path of a .json file"));
}

TEST(Profile, AllThatIsWrongInAFileIsToldWithItsPlace) {
  const std::string said = said_of_text(
      R"({"titel": "x", "most_targets": 0, "sparse": "some", "interpolations": ["LINAER"]})");
  EXPECT_THAT(said, HasSubstr("#/titel: error:"));
  EXPECT_THAT(said, HasSubstr("did you mean \"title\"?"));
  EXPECT_THAT(said, HasSubstr("[profile.missing-field]"));
  EXPECT_THAT(said, HasSubstr("#/most_targets: error: most_targets must be a whole number from 1"));
  EXPECT_THAT(said, HasSubstr("#/sparse: error:"));
  EXPECT_THAT(said, HasSubstr("#/interpolations/0: error:"));
}

TEST(Profile, OfNoFileOrNoJsonIsTold) {
  EXPECT_THAT(said_of("no/such.json"), HasSubstr("[files.missing]"));
  EXPECT_THAT(said_of_text("{"), HasSubstr("[json.syntax]"));
  EXPECT_THAT(said_of_text("[]"), HasSubstr("[profile.wrong-type]"));
}

TEST(Profile, OfAUsersOwnHasDefaultsForTheRest) {
  const std::string file = testing::TempDir() + "ours.json";
  std::ofstream(file) << R"({"title": "Our engine", "most_targets": 16})";
  const Profile profile = read_profile(file);
  std::filesystem::remove(file);
  EXPECT_EQ(profile.name, "ours");
  EXPECT_EQ(profile.most_targets, 16);
  EXPECT_FALSE(profile.most_active);
  EXPECT_EQ(profile.sparse, SparseSupport::Any);
  EXPECT_THAT(profile.interpolations, ElementsAre("LINEAR", "STEP", "CUBICSPLINE"));
}

TEST(Profile, ShippedOnesAreThoseOfTheFolder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    files.push_back(entry.path().stem().string());
  }
  std::sort(files.begin(), files.end());
  EXPECT_EQ(profile_names(), files);
  EXPECT_EQ(files.size(), 12U);
}

// Whatever stands in a file is read: it comes out again.
TEST(Profile, ShippedOnesFitTheSchemaAndEachFieldIsRead) {
  const Json schema = shipped_schema("profile.schema.json");
  for (const std::string& name : profile_names()) {
    Json file = read_json(kFolder + name + ".json", name);
    EXPECT_TRUE(schema_problems(file, schema, {name, ""}).empty()) << name;
    EXPECT_EQ(file["$schema"], "../../schemas/profile.schema.json") << name;
    file.erase("$schema");
    EXPECT_EQ(parse_json(profile_to_json(read_profile(name)), name).dump(2), file.dump(2));
  }
}

TEST(Profile, DefaultsAreThoseOfTheSchema) {
  Json defaults, fields;
  const Json schema = shipped_schema("profile.schema.json");
  for (const auto& [name, field] : schema["properties"].items()) {
    if (field.contains("default")) defaults[name] = field["default"];
    if (name != "$schema") fields.push_back(name);
  }
  Json written = parse_json(profile_to_json({}), "defaults");
  EXPECT_EQ(written["title"], "");  // required: it has no default
  written.erase("title");
  EXPECT_EQ(written, defaults);
  Profile full;
  for (auto limit :
       {&Profile::most_targets, &Profile::most_targets_with_normals, &Profile::most_active,
        &Profile::name_bytes, &Profile::gpu_bytes, &Profile::gpu_bytes_with_normals}) {
    full.*limit = 1;
  }
  Json all;
  const Json filled = parse_json(profile_to_json(full), "full");
  for (const auto& [name, value] : filled.items()) {
    all.push_back(name);
  }
  EXPECT_EQ(all, fields);
}

TEST(Profile, VerifiedOnesAreOfTheVersionsThatTheTestsRun) {
  const Json packages =
      read_json(MORPHBAKE_SOURCE_DIR "/tests/clients/package.json", "package.json");
  const Json& versions = packages["dependencies"];
  EXPECT_EQ(read_profile("web-three").version, versions["three"]);
  EXPECT_EQ(read_profile("babylon").version, versions["babylonjs"]);
  EXPECT_EQ(read_profile("spec-min").version, versions["gltf-validator"]);
  EXPECT_EQ(read_profile("archive").version, versions["gltf-validator"]);
  std::vector<std::string> verified;
  for (const Profile& profile : shipped_profiles()) {
    EXPECT_FALSE(profile.client.empty()) << profile.name;
    EXPECT_FALSE(profile.sources.empty()) << profile.name;
    if (profile.evidence == Evidence::Client) verified.push_back(profile.name);
  }
  EXPECT_THAT(verified, ElementsAre("archive", "babylon", "blender", "spec-min", "web-three"));
}

TEST(Profile, LimitsWithNormalsAreTheirOwnWhereGiven) {
  EXPECT_EQ(most_targets(read_profile("spec-min"), false), 8);
  EXPECT_EQ(most_targets(read_profile("spec-min"), true), 4);
  EXPECT_EQ(most_targets(read_profile("web-three"), true), 255);
  EXPECT_EQ(most_targets(read_profile("archive"), true), std::nullopt);
}

TEST(Profile, GpuBytesAreThoseOfVerticesAndTargets) {
  EXPECT_EQ(gpu_bytes(read_profile("web-three"), {100, 10}), 100 * 16 + 10 * 32);
  EXPECT_EQ(gpu_bytes(read_profile("bevy"), {100, 0}), 3600);
  EXPECT_EQ(gpu_bytes(read_profile("unity"), {100, 0}), std::nullopt);
  Profile half;
  half.gpu_bytes = 4;
  EXPECT_EQ(gpu_bytes(half, {100, 0}), 400);
  EXPECT_EQ(gpu_bytes(half, {100, 1}), std::nullopt);
}

}  // namespace
}  // namespace morphbake
