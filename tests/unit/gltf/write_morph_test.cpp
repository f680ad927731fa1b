#include "morphbake/gltf/write_morph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/gltf/document.h"
#include "morphbake/gltf/glb_draft.h"
#include "morphbake/gltf/morph_writing.h"

namespace morphbake {
namespace {

using ::testing::ElementsAre;

/// Three vertices and a triangle; the tests add to it.
struct Source {
  GlbDraft draft;

  Source() {
    draft.shown = "source.glb";
    draft.json = Json::parse(R"({
      "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {}}]}]})");
    primitive()["attributes"]["POSITION"] = append_vectors(draft, rows(0));
  }

  static Float3s rows(float first) {
    Float3s rows(3, 3);
    rows << first, 0, 0, 1, 0, 0, 0, 1, 0;
    return rows;
  }

  Json& primitive() { return draft.json["meshes"][0]["primitives"][0]; }

  int append_scalars(const std::vector<float>& values) {
    const int view =
        append_view(draft, values.data(), values.size() * sizeof(float), BufferUse::Other);
    return append_accessor(draft, {{"bufferView", view},
                                   {"componentType", kFloatComponent},
                                   {"count", values.size()},
                                   {"type", "SCALAR"},
                                   {"min", {values.front()}},
                                   {"max", {values.back()}}});
  }

  /// A target and an animation of its weights.
  void add_own_target() {
    primitive()["targets"] = {{{"POSITION", append_vectors(draft, rows(5))}}};
    add_animation(append_scalars({0, 1}), append_scalars({0, 1}));
  }

  void add_animation(int input, int output) {
    draft.json["animations"].push_back(
        {{"samplers", {{{"input", input}, {"output", output}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  }

  GltfFile open() const {
    GlbDraft copy = draft;
    return open_gltf_bytes(glb_bytes(copy), "source.glb");
  }
};

/// A morph with one target, "new", of a mesh with `primitives` primitives.
MeshMorph morph_of(std::size_t primitives) {
  MeshMorph morph;
  morph.target_names = {"new"};
  morph.clips = {{"clip", {0, 1}, Eigen::Vector2f(0, 1)}};
  for (std::size_t p = 0; p < primitives; ++p) {
    morph.primitives.push_back({Source::rows(0), {}, {Source::rows(2)}, {}});
  }
  return morph;
}

/// A new base shape, without targets.
MeshMorph still_of(std::size_t primitives, float first) {
  MeshMorph morph;
  morph.replaces_base = true;
  for (std::size_t p = 0; p < primitives; ++p) {
    morph.primitives.push_back({Source::rows(first), {}, {}, {}});
  }
  return morph;
}

GltfFile written(const GltfFile& source, const MeshMorph& morph) {
  return open_gltf_bytes(write_morph_glb(source, morph, "test"), "written.glb");
}

GltfFile written(const Source& source, const MeshMorph& morph) {
  return written(source.open(), morph);
}

/// Numbers of the accessor that `pointer` names.
std::vector<float> numbers_at(const GltfFile& file, const std::string& pointer) {
  const tinygltf::Model& model = file->model;
  const auto& accessor =
      model.accessors.at(file->json.at(Json::json_pointer(pointer)).get<std::size_t>());
  const auto& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  const std::size_t columns = accessor.type == TINYGLTF_TYPE_SCALAR ? 1 : 3;
  std::vector<float> numbers(accessor.count * columns);
  std::memcpy(numbers.data(), file->buffers.at(0).data() + view.byteOffset,
              numbers.size() * sizeof(float));
  return numbers;
}

const std::string kPrimitives = "/meshes/0/primitives/";

TEST(WriteMorph, RefusesCurvesThatMultiplySharedBytes) {
  Source source;
  source.add_own_target();
  constexpr std::size_t kKeys = 100000;
  std::vector<float> times(kKeys);
  for (std::size_t k = 0; k < kKeys; ++k) times[k] = static_cast<float>(k);
  const int input = source.append_scalars(times);
  for (int i = 0; i < 50; ++i) {
    const int output = append_accessor(source.draft, source.draft.accessors.back());
    source.add_animation(input, output);
  }
  try {
    written(source, morph_of(1));
    FAIL() << "it was written";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems().front().code, "gltf.too-large");
  }
}

TEST(WriteMorph, RefusesAPoseThatTheNodeFlattens) {
  Source source;
  source.draft.json["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0, "scale": [1, 0, 1]}, {}])");
  source.draft.json["skins"] = Json::parse(R"([{"joints": [1]}])");
  MeshMorph morph = still_of(1, 3);
  morph.drops_skin = true;
  try {
    written(source, morph);
    FAIL() << "it was written";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems().front().code, "gltf.singular-transform");
    EXPECT_EQ(error.problems().front().location.pointer, "/nodes/0");
  }
}

TEST(WriteMorph, AVertexIsWhereThePrimitiveThatUsesItHasIt) {
  Source source;
  source.draft.json["meshes"][0]["primitives"].push_back(Json(source.primitive()));
  MeshMorph morph = still_of(2, 7);
  morph.primitives[1].positions = Source::rows(9);
  morph.primitives[1].positions(1, 1) = 8;
  morph.primitives[0].is_used = {true, false, false};
  morph.primitives[1].is_used = {false, true, true};
  const GltfFile file = written(source, morph);
  EXPECT_THAT(numbers_at(file, kPrimitives + "0/attributes/POSITION"),
              ElementsAre(7, 0, 0, 1, 8, 0, 0, 1, 0));
  EXPECT_EQ(file->model.accessors.size(), 1U);
}

TEST(WriteMorph, PrimitivesThatDisagreeAboutAVertexGetOneEach) {
  Source source;
  source.draft.json["meshes"][0]["primitives"].push_back(Json(source.primitive()));
  MeshMorph morph = still_of(2, 7);
  morph.primitives[1].positions = Source::rows(9);
  const GltfFile file = written(source, morph);
  EXPECT_EQ(numbers_at(file, kPrimitives + "0/attributes/POSITION").front(), 7);
  EXPECT_EQ(numbers_at(file, kPrimitives + "1/attributes/POSITION").front(), 9);
  EXPECT_EQ(file->model.accessors.size(), 2U);
}

TEST(WriteMorph, NewNamesAreOtherThanOwnOnes) {
  Source source;
  source.add_own_target();
  source.draft.json["meshes"][0]["extras"]["targetNames"] = {"new"};
  source.draft.json["animations"][0]["name"] = "clip";
  const GltfFile file = written(source, morph_of(1));
  EXPECT_EQ(file->json["meshes"][0]["extras"]["targetNames"], Json::array({"new", "new-2"}));
  EXPECT_EQ(file->json["animations"][1]["name"], "clip-2");
}

TEST(WriteMorph, NamesThatAreNoTextAreNoNames) {
  Source source;
  source.add_own_target();
  source.primitive()["targets"].push_back(Json(source.primitive()["targets"][0]));
  source.draft.json["meshes"][0]["extras"]["targetNames"] = {7};
  source.draft.json["animations"] =
      Json::array({{{"name", 7}, {"samplers", Json::array()}, {"channels", Json::array()}}});
  const GltfFile file = written(source, morph_of(1));
  EXPECT_EQ(file->json["meshes"][0]["extras"]["targetNames"], Json::array({7, "1", "new"}));
  EXPECT_EQ(file->json["animations"][1]["name"], "clip");
}

TEST(WriteMorph, FreeNamesFitIntoBlender) {
  EXPECT_EQ(free_name("a", {}), "a");
  EXPECT_EQ(free_name("a", {"a", "a-2"}), "a-3");
  std::string umlauts;
  for (int i = 0; i < 31; ++i) umlauts += "\xC3\xB6";
  const std::string free = free_name(umlauts, {umlauts});
  EXPECT_EQ(free, umlauts.substr(0, 60) + "-2");
}

TEST(WriteMorph, AnimationsByPointerGetNumbersForNewTargets) {
  for (const char* pointer : {"/nodes/0/weights", "/meshes/0/weights"}) {
    Source source;
    source.add_own_target();
    source.draft.json["animations"][0]["channels"][0]["target"] = {
        {"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
    const GltfFile file = written(source, morph_of(1));
    EXPECT_THAT(numbers_at(file, "/animations/0/samplers/0/output"), ElementsAre(0, 0, 1, 0));
  }
}

TEST(WriteMorph, WhatIsReadBackIsWhatWasWritten) {
  Source source;
  source.add_own_target();
  source.draft.json["meshes"][0]["weights"] = {0.5};
  const std::string moving = write_morph_glb(source.open(), morph_of(1), "test");
  const AnimatedMesh clip = read_written_mesh(moving, "written.glb", 0, 1).mesh;
  EXPECT_EQ(weights_at(clip, 1), Eigen::Vector2d(0.5, 1));
  // A still adds no animation: the file's own ones do not count.
  const std::string still = write_morph_glb(source.open(), still_of(1, 7), "test");
  const AnimatedMesh rest = read_written_mesh(still, "written.glb", 0, 0).mesh;
  EXPECT_EQ(weights_at(rest, 1)(0), 0.5);
  EXPECT_EQ(rest.primitives[0].positions(0, 0), 7 - 0.5F * 5);
}

TEST(WriteMorph, ClipsAreAnimationsOverTheSameTargets) {
  MeshMorph morph = morph_of(1);
  morph.clips.push_back({"back", {0, 2}, Eigen::Vector2f(1, 0.25F)});
  const WrittenMesh read =
      read_written_mesh(write_morph_glb(Source().open(), morph, "test"), "written.glb", 0, 2);
  ASSERT_EQ(read.clips.size(), 2U);
  EXPECT_EQ(read.clips[0].times, (std::vector<float>{0, 1}));
  EXPECT_EQ(read.clips[0].values(1, 0), 1);
  EXPECT_EQ(read.clips[1].times, (std::vector<float>{0, 2}));
  EXPECT_EQ(read.clips[1].values(0, 0), 1);
  EXPECT_EQ(read.clips[1].values(1, 0), 0.25F);
}

TEST(WriteMorph, OtherPointersStay) {
  for (const char* pointer :
       {"/nodes/1/weights", "/meshes/1/weights", "/nodes/0/weights/0", "/nodes//weights",
        "/nodes/weights", "/materials/0/emissiveFactor", "/nodes/0x/weights", ""}) {
    Source source;
    source.add_own_target();
    source.draft.json["nodes"].push_back(Json::object());
    source.draft.json["animations"][0]["channels"][0]["target"] = {
        {"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
    const GltfFile file = written(source, morph_of(1));
    EXPECT_THAT(numbers_at(file, "/animations/0/samplers/0/output"), ElementsAre(0, 1)) << pointer;
  }
}

TEST(WriteMorph, CurvesThatAreReadTwiceAreWrittenOnce) {
  Source source;
  source.add_own_target();
  Json twice = source.draft.json["animations"][0];
  source.draft.json["animations"].push_back(std::move(twice));
  const std::size_t before = source.draft.accessors.size();
  const GltfFile file = written(source, morph_of(1));
  // New: the target, and input and output of the new animation.
  EXPECT_EQ(file->model.accessors.size(), before + 3);
  EXPECT_THAT(numbers_at(file, "/animations/0/samplers/0/output"), ElementsAre(0, 0, 1, 0));
  EXPECT_EQ(file->json["animations"][0]["samplers"], file->json["animations"][1]["samplers"]);
}

TEST(WriteMorph, ASamplerThatMovesSomethingElseTooStaysForThat) {
  Source source;
  source.add_own_target();
  source.draft.json["nodes"].push_back(Json::object());
  Json& animation = source.draft.json["animations"][0];
  animation["channels"].push_back({{"sampler", 0}, {"target", {{"node", 1}, {"path", "weights"}}}});
  const GltfFile file = written(source, morph_of(1));
  EXPECT_EQ(file->json["animations"][0]["channels"][0]["sampler"], 1);
  EXPECT_EQ(file->json["animations"][0]["channels"][1]["sampler"], 0);
  EXPECT_THAT(numbers_at(file, "/animations/0/samplers/0/output"), ElementsAre(0, 1));
  EXPECT_THAT(numbers_at(file, "/animations/0/samplers/1/output"), ElementsAre(0, 0, 1, 0));
}

/// Tells the first position by a sparse accessor.
void make_sparse(Source& source) {
  const std::uint16_t first = 0;
  const float value[] = {4, 4, 4};
  const int index = append_view(source.draft, &first, sizeof first, BufferUse::Other);
  const int values = append_view(source.draft, value, sizeof value, BufferUse::Other);
  source.draft.accessors[0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", index}, {"componentType", 5123}}},
      {"values", {{"bufferView", values}}}};
}

TEST(WriteMorph, NothingIsLeftOfASparseAccessor) {
  Source source;
  make_sparse(source);
  source.primitive()["attributes"]["TEXCOORD_0"] = append_accessor(
      source.draft, {{"bufferView", append_view(source.draft, "01234567012345670123456", 24,
                                                BufferUse::Vertices)},
                     {"componentType", kFloatComponent},
                     {"count", 3},
                     {"type", "VEC2"}});
  const GltfFile file = written(source, still_of(1, 7));
  EXPECT_EQ(file->model.bufferViews.size(), 2U);
  EXPECT_EQ(file->model.accessors.size(), 2U);
  EXPECT_EQ(file->buffers.at(0).size(), 36U + 24U);
  EXPECT_THAT(numbers_at(file, kPrimitives + "0/attributes/POSITION"),
              ElementsAre(7, 0, 0, 1, 0, 0, 0, 1, 0));
  const auto& kept = file->model.bufferViews.at(1);
  const char* bytes = file->buffers.at(0).data() + kept.byteOffset;
  EXPECT_EQ(std::string_view(bytes, 23), "01234567012345670123456");
}

TEST(WriteMorph, WhatWasUnusedBeforeStays) {
  Source source;
  source.append_scalars({1, 2, 3});
  const std::size_t bytes = source.draft.binary.size();
  const GltfFile file = written(source, still_of(1, 7));
  EXPECT_EQ(file->model.accessors.size(), 2U);
  EXPECT_EQ(file->buffers.at(0).size(), bytes);
}

TEST(WriteMorph, NothingMovesUnderAnExtensionThatNobodyKnows) {
  Source source;
  make_sparse(source);
  source.draft.json["nodes"][0]["extensions"]["EXAMPLE_points"] = {{"accessor", 0}, {"view", 2}};
  const std::size_t bytes = source.draft.binary.size();
  const GltfFile file = written(source, still_of(1, 7));
  EXPECT_EQ(file->model.bufferViews.size(), 3U);
  EXPECT_GE(file->buffers.at(0).size(), bytes);
}

/// A posed node of a skin, and another node that has the skin and, if wanted, the mesh.
Source skinned_twins(bool share_mesh) {
  Source source;
  const unsigned char joints[12] = {};
  const float weights[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const auto append = [&](const void* data, std::size_t size, int component) {
    return append_accessor(
        source.draft, {{"bufferView", append_view(source.draft, data, size, BufferUse::Vertices)},
                       {"componentType", component},
                       {"count", 3},
                       {"type", "VEC4"}});
  };
  source.primitive()["attributes"]["JOINTS_0"] = append(joints, sizeof joints, 5121);
  source.primitive()["attributes"]["WEIGHTS_0"] = append(weights, sizeof weights, kFloatComponent);
  source.draft.json["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0}, {}, {"skin": 1}])");
  if (share_mesh) source.draft.json["nodes"][2]["mesh"] = 0;
  source.draft.json["skins"] = Json::parse(R"([{"joints": [1]}, {"joints": [1]}])");
  return source;
}

TEST(WriteMorph, APosedMeshHangsOnNoJoints) {
  MeshMorph morph = still_of(1, 3);
  morph.drops_skin = true;
  const GltfFile file = written(skinned_twins(false), morph);
  EXPECT_EQ(file->json["meshes"].size(), 1U);
  EXPECT_EQ(file->json["meshes"][0]["primitives"][0]["attributes"].size(), 1U);
  EXPECT_EQ(file->model.accessors.size(), 1U);
  EXPECT_EQ(file->json["nodes"], Json::parse(R"([{"mesh": 0}, {}, {"skin": 0}])"));
  EXPECT_EQ(file->json["skins"].size(), 1U);
}

TEST(WriteMorph, AnotherNodeThatIsPosedKeepsItsMesh) {
  MeshMorph morph = still_of(1, 3);
  morph.drops_skin = true;
  const GltfFile file = written(skinned_twins(true), morph);
  EXPECT_EQ(file->json["nodes"], Json::parse(R"([{"mesh": 1}, {}, {"skin": 0, "mesh": 0}])"));
  EXPECT_EQ(numbers_at(file, "/meshes/0/primitives/0/attributes/POSITION").front(), 0);
  EXPECT_EQ(numbers_at(file, "/meshes/1/primitives/0/attributes/POSITION").front(), 3);
  EXPECT_TRUE(file->json["meshes"][0]["primitives"][0]["attributes"].contains("JOINTS_0"));
  EXPECT_FALSE(file->json["meshes"][1]["primitives"][0]["attributes"].contains("JOINTS_0"));
}

TEST(WriteMorph, TargetsWithoutNormalsGetZerosThatAreTold) {
  Source source;
  source.add_own_target();
  source.draft.json.erase("animations");
  source.primitive()["attributes"]["NORMAL"] = append_vectors(source.draft, Source::rows(0));
  source.primitive()["targets"].push_back(Json(source.primitive()["targets"][0]));
  MeshMorph morph = morph_of(1);
  morph.primitives[0].normals = Source::rows(0);
  morph.primitives[0].target_normals = {Source::rows(0)};
  const GltfFile file = written(source, morph);
  const Json& targets = file->json["meshes"][0]["primitives"][0]["targets"];
  EXPECT_EQ(targets[0]["NORMAL"], targets[1]["NORMAL"]);
  EXPECT_EQ(file->json["accessors"][targets[0]["NORMAL"].get<std::size_t>()]["sparse"]["count"], 1);
  const AnimatedMesh mesh = read_animated_mesh(file);
  EXPECT_TRUE(mesh.primitives[0].target_normals[1].isZero(0));
}

}  // namespace
}  // namespace morphbake
