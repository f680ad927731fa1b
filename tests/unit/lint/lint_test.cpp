#include "morphbake/lint/lint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "morphbake/diagnostics/problem.h"
#include "shapes/morph_file.h"

namespace morphbake {
namespace {

using test::kInt16;
using test::kInt8;
using test::MorphFile;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

using Codes = std::vector<std::string>;

Codes codes_of(const LintReport& report) {
  Codes codes;
  for (const Finding& finding : report.findings) codes.push_back(finding.rule);
  return codes;
}

Codes codes_of(const MorphFile& file, const Profile& profile, const LintOptions& options = {}) {
  return codes_of(lint(file.open(), profile, {}, options));
}

Codes codes_of(const MorphFile& file, const std::string& profile = "web-three") {
  return codes_of(file, read_profile(profile));
}

Finding first_finding(const MorphFile& file, const std::string& profile = "web-three") {
  const LintReport report = lint(file.open(), read_profile(profile));
  return report.findings.empty() ? Finding{} : report.findings.front();
}

/// A profile that reads everything.
Profile lenient() { return read_profile("web-three"); }

TEST(Lint, OfAFileThatIsRightFindsNothingForAnyProfile) {
  for (const std::string& name : profile_names()) {
    EXPECT_THAT(codes_of(MorphFile(4, true), name), IsEmpty()) << name;
    EXPECT_THAT(codes_of(MorphFile(8, false), name), IsEmpty()) << name;
  }
}

TEST(Lint, RulesHaveCodesOfTheirOwnAndWords) {
  Codes codes;
  for (const LintRule& rule : lint_rules()) {
    EXPECT_THAT(codes, Not(Contains(std::string(rule.code))));
    EXPECT_NE(std::string(rule.meaning), "");
    codes.emplace_back(rule.code);
  }
}

TEST(Lint, CountsTargets) {
  EXPECT_THAT(codes_of(MorphFile(5, true), "spec-min"), ElementsAre("too-many-targets"));
  EXPECT_THAT(codes_of(MorphFile(9, false), "spec-min"), ElementsAre("too-many-targets"));
  EXPECT_THAT(codes_of(MorphFile(255, false)), IsEmpty());
  const Finding finding = first_finding(MorphFile(256, false));
  EXPECT_EQ(finding.rule, "too-many-targets");
  EXPECT_EQ(finding.pointer, "/meshes/0");
  EXPECT_EQ(finding.message, "256 morph targets; three.js reads at most 255");
}

TEST(Lint, CountsActiveTargetsAlsoBetweenKeys) {
  MorphFile file(3);
  Profile profile = lenient();
  profile.most_active = 2;
  // One at each key, two between them.
  file.set_weights({0, 1, 2}, {1, 0, 0, 0, 1, 0, 1, 0, 0});
  file.mesh()["weights"] = {1, 0, 0};
  EXPECT_THAT(codes_of(file, profile), IsEmpty());
  profile.most_active = 1;
  EXPECT_THAT(codes_of(file, profile), ElementsAre("too-many-active"));
  file.sampler()["interpolation"] = "STEP";
  EXPECT_THAT(codes_of(file, profile), IsEmpty());
}

TEST(Lint, WantsEqualAttributesOfAllTargets) {
  MorphFile file(3, true);
  file.target(1).erase("NORMAL");
  const Finding finding = first_finding(file);
  EXPECT_EQ(finding.rule, "unequal-attributes");
  EXPECT_EQ(finding.severity, FindingSeverity::Error);
  EXPECT_EQ(finding.pointer, "/meshes/0/primitives/0/targets/1");
  EXPECT_EQ(finding.message, "the target moves POSITION, others NORMAL, POSITION");
}

TEST(Lint, WantsWhatTargetsMoveInThePrimitive) {
  MorphFile file(2, true);
  file.primitive()["attributes"].erase("NORMAL");
  EXPECT_THAT(codes_of(file), ElementsAre("attribute-without-base"));
}

TEST(Lint, NotesAMeshWithoutTargets) {
  MorphFile file(0);
  file.primitive().erase("targets");
  file.mesh().erase("weights");
  EXPECT_THAT(codes_of(file), ElementsAre("no-targets"));
}

TEST(Lint, CountsVerticesWithoutTriangles) {
  MorphFile file;
  file.primitive()["indices"] = file.append({0, 1, 2}, "SCALAR", {5125});
  const Finding finding = first_finding(file);
  EXPECT_EQ(finding.rule, "unused-vertices");
  EXPECT_EQ(finding.message, "1 of 4 vertices belong to no triangle");
}

TEST(Lint, VerticesOfPrimitivesThatShareThemAreUsed) {
  MorphFile file;
  file.primitive()["indices"] = file.append({0, 1, 2}, "SCALAR", {5125});
  Json second = file.primitive();
  second["indices"] = file.append({1, 2, 3}, "SCALAR", {5125});
  file.mesh()["primitives"].push_back(second);
  EXPECT_THAT(codes_of(file), IsEmpty());
}

TEST(Lint, FindsSparseAccessors) {
  MorphFile file;
  file.make_sparse(file.target(0)["POSITION"], false);
  EXPECT_THAT(codes_of(file), IsEmpty());
  EXPECT_THAT(codes_of(file, "babylon"), IsEmpty());
  EXPECT_THAT(codes_of(file, "blender"), IsEmpty());
  EXPECT_THAT(codes_of(file, "filament"), ElementsAre("sparse"));
  EXPECT_THAT(codes_of(file, "cesium"), ElementsAre("sparse"));
}

TEST(Lint, FindsSparseAccessorsWithoutAViewWhereOneIsNeeded) {
  MorphFile file;
  file.make_sparse(file.target(0)["POSITION"], false);
  Profile godot3 = lenient();
  godot3.sparse = SparseSupport::WithView;
  EXPECT_THAT(codes_of(file, godot3), ElementsAre("sparse-without-view"));
}

TEST(Lint, FindsSparseAccessorsOverASharedView) {
  MorphFile file;
  const int zeros = file.append(std::vector<double>(12, 0), "VEC3");
  for (const int t : {0, 1}) {
    Json copy = file.accessor(zeros);
    copy["max"] = {0, 0, 0.5};
    file.target(t)["POSITION"] = append_accessor(file.draft, copy);
    file.make_sparse(file.target(t)["POSITION"], true);
  }
  EXPECT_THAT(codes_of(file), IsEmpty());
  EXPECT_THAT(codes_of(file, "babylon"), ElementsAre("sparse-over-shared-view"));
}

TEST(Lint, FindsAccessorsWithNeitherViewNorSparse) {
  MorphFile file;
  Json& accessor = file.accessor(file.target(1)["POSITION"]);
  accessor.erase("bufferView");
  accessor["min"] = accessor["max"] = {0, 0, 0};
  EXPECT_THAT(codes_of(file), IsEmpty());
  EXPECT_THAT(codes_of(file, "spec-min"), ElementsAre("accessor-of-zeros"));
}

MorphFile quantized_file() {
  MorphFile file;
  file.draft.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  file.draft.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  std::vector<double> positions = {0, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 0, 32767};
  file.primitive()["attributes"]["POSITION"] = file.append(positions, "VEC3", kInt16);
  for (const int t : {0, 1}) {
    file.target(t)["POSITION"] =
        file.append({0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", kInt16);
  }
  file.node()["scale"] = {2, 2, 2};
  return file;
}

TEST(Lint, FindsQuantization) {
  EXPECT_THAT(codes_of(quantized_file()), IsEmpty());
  EXPECT_THAT(codes_of(quantized_file(), "godot4"), ElementsAre("quantization"));
  EXPECT_THAT(codes_of(quantized_file(), "bevy"), ElementsAre("quantization"));
}

TEST(Lint, WantsVertexAttributesAtMultiplesOfFourBytes) {
  MorphFile file = quantized_file();
  file.target(0)["POSITION"] =
      file.append({0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", {5122, true, 0});
  const Finding finding = first_finding(file);
  EXPECT_EQ(finding.rule, "attribute-stride");
  EXPECT_THAT(finding.message, HasSubstr("6 bytes follow one another every 6 bytes"));
  EXPECT_THAT(finding.right, HasSubstr("byteStride of 8"));
}

TEST(Lint, TellsWhereQuantizedDeltasLookCutOff) {
  MorphFile file = quantized_file();
  file.target(0)["POSITION"] =
      file.append({32767, 5, 0, 32767, 0, 0, 32767, 9, 0, 0, 0, 0}, "VEC3", kInt16);
  EXPECT_THAT(codes_of(file), ElementsAre("quantized-range"));
  // A largest one, and all moved alike, are what a good scale gives.
  file.target(0)["POSITION"] =
      file.append({32767, 5, 0, 0, 0, 0, -32767, 9, 0, 0, 0, 0}, "VEC3", kInt16);
  EXPECT_THAT(codes_of(file), IsEmpty());
  file.target(0)["POSITION"] =
      file.append({32767, 5, 0, 32767, 5, 0, 32767, 5, 0, 32767, 5, 0}, "VEC3", kInt16);
  EXPECT_THAT(codes_of(file), IsEmpty());
}

TEST(Lint, TellsWhereNormalDeltasWereCutOff) {
  MorphFile file(2, true);
  // From (1, 0, 0) to (-1, 0, 0) is a delta of 2: cut off at 1 it leads to nothing.
  file.target(0)["NORMAL"] = file.append({-127, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", kInt8);
  const Finding finding = first_finding(file);
  EXPECT_EQ(finding.rule, "quantized-normals");
  EXPECT_THAT(finding.message, HasSubstr("normals of 1 vertices were cut off"));
  // From (1, 0, 0) to (0, 1, 0) is a delta of exactly 1 and all right.
  file.target(0)["NORMAL"] = file.append({-127, 127, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", kInt8);
  EXPECT_THAT(codes_of(file), IsEmpty());
}

TEST(Lint, WantsTheScaleOfAQuantizedMeshOnANodeOfItsOwn) {
  MorphFile file = quantized_file();
  file.draft.json["nodes"].push_back({{"name", "Child"}});
  file.node()["children"] = {1};
  EXPECT_THAT(codes_of(file), ElementsAre("quantized-node"));
  EXPECT_EQ(first_finding(file).pointer, "/nodes/0");
  file.node().erase("scale");
  EXPECT_THAT(codes_of(file), IsEmpty());
}

TEST(Lint, TellsThatASkinIgnoresTheScale) {
  MorphFile file = quantized_file();
  file.draft.json["nodes"].push_back({{"name", "Joint"}});
  file.draft.json["scenes"][0]["nodes"] = {0, 1};
  file.draft.json["skins"] = {{{"joints", {1}}}};
  file.node()["skin"] = 0;
  EXPECT_THAT(first_finding(file).message, HasSubstr("a skin, which ignores it"));
}

TEST(Lint, ComparesBoundsWithTheNumbers) {
  MorphFile file;
  file.accessor(file.target(1)["POSITION"])["max"] = {0.3, 0, 0};
  const Finding finding = first_finding(file);
  EXPECT_EQ(finding.rule, "bounds");
  EXPECT_EQ(finding.severity, FindingSeverity::Error);
  EXPECT_THAT(finding.message, HasSubstr("max (0.3, 0, 0) are declared"));
  file.accessor(file.target(1)["POSITION"]).erase("max");
  EXPECT_EQ(first_finding(file).message, "the accessor has no min and max");
}

TEST(Lint, BoundsOfDecimalsAreThoseOfFloats) {
  MorphFile file;
  file.target(0)["POSITION"] = file.append({0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  EXPECT_THAT(codes_of(file), IsEmpty());
}

TEST(Lint, WantsAnInterpolationThatTheClientShows) {
  MorphFile file(1);
  file.set_weights({0, 1}, {0, 0, 0, 0, 0, 0});
  file.sampler()["interpolation"] = "CUBICSPLINE";
  EXPECT_THAT(codes_of(file), IsEmpty());
  for (const char* profile : {"playcanvas", "unity", "spec-min", "blender"}) {
    EXPECT_THAT(codes_of(file, profile), ElementsAre("interpolation")) << profile;
  }
  EXPECT_EQ(first_finding(file, "playcanvas").pointer, "/animations/0/samplers/0");
}

TEST(Lint, WantsDenseFloatWeights) {
  MorphFile file(1);
  file.sampler()["output"] = file.append({0, 255, 0}, "SCALAR", {5121, true, 0});
  EXPECT_THAT(codes_of(file), ElementsAre("integer-weights"));
  file.sampler()["output"] = file.append({0, 1, 0}, "SCALAR");
  Json& output = file.accessor(file.sampler()["output"]);
  const std::uint32_t row = 1;
  const float value = 0.5F;
  const int rows = append_view(file.draft, &row, sizeof row, BufferUse::Other);
  const int values = append_view(file.draft, &value, sizeof value, BufferUse::Other);
  output["sparse"] = {{"count", 1},
                      {"indices", {{"bufferView", rows}, {"componentType", 5125}}},
                      {"values", {{"bufferView", values}}}};
  EXPECT_THAT(codes_of(file), ElementsAre("sparse-weights"));
}

TEST(Lint, WantsWeightsInRangeWhereTheyAreClamped) {
  MorphFile file(1);
  file.set_weights({0, 1, 2}, {0, 1.5, 0});
  EXPECT_THAT(codes_of(file), IsEmpty());
  EXPECT_THAT(codes_of(file, "blender"), ElementsAre("weights-range"));
  EXPECT_THAT(first_finding(file, "blender").message, HasSubstr("from 0 to 1.5; Blender clamps"));
}

TEST(Lint, NotesAFirstKeyThatIsNotAtZero) {
  MorphFile file(1);
  file.set_weights({0.5, 1}, {0, 0});
  EXPECT_THAT(codes_of(file), ElementsAre("first-key"));
}

TEST(Lint, NotesAnOpenLoopAndRefusesItWhereOneIsAskedFor) {
  MorphFile file(1);
  file.set_weights({0, 1}, {0, 1});
  EXPECT_THAT(codes_of(file), ElementsAre("open-loop"));
  EXPECT_THAT(codes_of(file, lenient(), {.must_loop = true}), ElementsAre("loop"));
}

TEST(Lint, ComparesRestWeightsWithTheFirstFrame) {
  MorphFile file(2);
  file.mesh()["weights"] = {0.5, 0};
  EXPECT_THAT(codes_of(file), ElementsAre("rest-weights"));
  file.node()["weights"] = {0, 0};  // which stand for the mesh's
  EXPECT_THAT(codes_of(file), IsEmpty());
  file.node().erase("weights");
  file.mesh().erase("weights");
  EXPECT_THAT(codes_of(file), IsEmpty());  // as rest is where it begins
  file.set_weights({0, 1}, {1, 0, 1, 0});
  EXPECT_THAT(codes_of(file), ElementsAre("rest-weights"));
  file.mesh()["weights"] = {1};
  EXPECT_THAT(codes_of(file), Contains("weights-length"));
}

TEST(Lint, LooksAtNames) {
  MorphFile file;
  Json& names = file.mesh()["extras"]["targetNames"];
  names[1] = names[0];
  EXPECT_THAT(codes_of(file), ElementsAre("double-name"));
  names[1] = "";
  EXPECT_THAT(codes_of(file), IsEmpty());
  EXPECT_THAT(codes_of(file, "blender"), ElementsAre("empty-name"));
  names[1] = "mouth:smile";
  EXPECT_THAT(codes_of(file), IsEmpty());
  EXPECT_THAT(codes_of(file, "godot4"), ElementsAre("name-characters"));
  names[1] = std::string(63, 'x');
  EXPECT_THAT(codes_of(file, "blender"), IsEmpty());
  names[1] = std::string(64, 'x');
  EXPECT_THAT(codes_of(file, "blender"), ElementsAre("long-name"));
  names = {"only"};
  EXPECT_THAT(codes_of(file), ElementsAre("missing-names"));
  file.mesh().erase("extras");
  EXPECT_THAT(codes_of(file), ElementsAre("missing-names"));
}

TEST(Lint, TellsManyFaultsAlikeOnce) {
  MorphFile file(6);
  for (int t = 1; t < 6; ++t) file.mesh()["extras"]["targetNames"][t] = "same";
  const LintReport report = lint(file.open(), lenient());
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].pointer, "/meshes/0/extras/targetNames/2");
  EXPECT_EQ(report.findings[0].message, "the name \"same\" is there before (4 places in all)");
}

TEST(Lint, MeasuresTheMotion) {
  MorphFile file(2);
  file.node()["translation"] = {10, 0, 0};
  file.set_weights({0, 1, 2}, {0, 0, 1, 4, 0, 0});
  const LintReport report = lint(file.open(), lenient());
  ASSERT_EQ(report.meshes.size(), 1U);
  const LintedMesh& mesh = report.meshes[0];
  EXPECT_EQ(mesh.rest.max().x(), 11);
  EXPECT_EQ(mesh.motion.min().x(), 10);
  EXPECT_EQ(mesh.motion.max().x(), 12);  // target 1 moves vertex 1 by 4 * 0.25
  EXPECT_EQ(mesh.motion_poses, 3);
  EXPECT_FALSE(mesh.is_motion_sampled);
  EXPECT_EQ(mesh.most_active, 2);
}

TEST(Lint, TellsGpuMemoryByEngine) {
  const LintReport report = lint(MorphFile(3, true).open(), lenient());
  const auto& gpu = report.meshes.at(0).gpu;
  const auto three = std::ranges::find(gpu, "web-three", &GpuMemory::profile);
  ASSERT_NE(three, gpu.end());
  EXPECT_EQ(three->bytes, 3 * 4 * 32);
  EXPECT_EQ(std::ranges::find(gpu, "unity", &GpuMemory::profile), gpu.end());
}

TEST(Lint, LooksAtEachMeshWithTargetsOnceOrAtTheChosenNode) {
  MorphFile file(1);
  Json& json = file.draft.json;
  json["meshes"].push_back(json["meshes"][0]);
  json["meshes"][1]["primitives"][0]["targets"].push_back(file.target(0));
  json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 1}, {"name", "Second"}}};
  json["scenes"][0]["nodes"] = {0, 1, 2};
  const LintReport report = lint(file.open(), lenient());
  ASSERT_EQ(report.meshes.size(), 2U);
  EXPECT_EQ(report.meshes[1].node_name, "Second");
  EXPECT_THAT(codes_of(report), ElementsAre("weights-length", "missing-names"));
  EXPECT_EQ(lint(file.open(), lenient(), {.node = 1}).meshes.size(), 1U);
  EXPECT_THROW(lint(file.open(), lenient(), {.node = "Third"}), BakeError);
}

TEST(Lint, StopsWhenItIsAskedTo) {
  Observer observer;
  observer.is_cancelled = [] { return true; };
  EXPECT_THROW(lint(MorphFile().open(), lenient(), {}, {}, observer), Cancelled);
}

}  // namespace
}  // namespace morphbake
