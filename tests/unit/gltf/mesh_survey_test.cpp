#include "morphbake/gltf/mesh_survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "morphbake/diagnostics/problem.h"
#include "shapes/morph_file.h"

namespace morphbake {
namespace {

using test::MorphFile;
using ::testing::ElementsAre;

/// POSITION of the first target.
StoredAccessor first_position(const MorphFile& file) {
  return survey_mesh(file.open()).primitives.at(0).targets.at(0).at(0).accessor;
}

TEST(MeshSurvey, TellsHowAnAccessorIsStored) {
  MorphFile file;
  file.target(0)["POSITION"] =
      file.append({0, 0, 0, -5, 0, 0, 0, 0, 0, 0, 0, 7}, "VEC3", test::kInt16);
  const StoredAccessor accessor = first_position(file);
  EXPECT_EQ(accessor.component_type, 5122);
  EXPECT_TRUE(accessor.is_normalized);
  EXPECT_EQ(accessor.columns, 3);
  EXPECT_EQ(accessor.count, 4U);
  EXPECT_EQ(accessor.stride, 8U);
  EXPECT_FALSE(accessor.is_sparse);
  EXPECT_FALSE(accessor.is_meshopt);
  EXPECT_EQ(accessor.file_bytes, 32);
  EXPECT_THAT(accessor.declared_min, ElementsAre(-5, 0, 0));
  EXPECT_THAT(accessor.actual_min, ElementsAre(-5, 0, 0));
  EXPECT_THAT(accessor.actual_max, ElementsAre(0, 0, 7));
}

TEST(MeshSurvey, AccessorsShareTheBytesOfTheirView) {
  MorphFile file;
  Json copy = file.accessor(file.target(0)["POSITION"]);
  file.target(1)["POSITION"] = append_accessor(file.draft, copy);
  EXPECT_EQ(first_position(file).file_bytes, 24);
}

TEST(MeshSurvey, SparseAccessorsTakeTheirElementsAlone) {
  MorphFile file;
  file.make_sparse(file.target(0)["POSITION"], false);
  const StoredAccessor accessor = first_position(file);
  EXPECT_TRUE(accessor.is_sparse);
  EXPECT_EQ(accessor.view, -1);
  EXPECT_EQ(accessor.file_bytes, 4 + 12);
  EXPECT_THAT(accessor.actual_max, ElementsAre(0, 0, 0.5));
}

// meshoptimizer's encoding of four vertices of three floats: zeros, but the first number of the
// second one, which is 0.25.
constexpr std::array<unsigned char, 57> kPacked = {0xa0, 0, 0,    1, 0x3c, 0, 0,    0,   0xff,
                                                   0xff, 1, 0x3c, 0, 0,    0, 0x7c, 0x7b};

TEST(MeshSurvey, OfCompressedAccessorsTellsWhatTheFileHas) {
  MorphFile file;
  file.draft.json["extensionsUsed"] = {"EXT_meshopt_compression"};
  const int packed = append_view(file.draft, kPacked.data(), kPacked.size(), BufferUse::Other);
  const Json range = file.draft.views[static_cast<std::size_t>(packed)];
  Json& view = file.view_of(file.target(0)["POSITION"]);
  view["byteStride"] = 12;
  view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                   {"byteOffset", range["byteOffset"]},
                                                   {"byteLength", kPacked.size()},
                                                   {"byteStride", 12},
                                                   {"count", 4},
                                                   {"mode", "ATTRIBUTES"}};
  const MeshSurvey survey = survey_mesh(file.open());
  EXPECT_THAT(survey.extensions_used, ElementsAre("EXT_meshopt_compression"));
  const StoredAccessor& accessor = survey.primitives.at(0).targets.at(0).at(0).accessor;
  EXPECT_TRUE(accessor.is_meshopt);
  EXPECT_EQ(accessor.file_bytes, 57);
  EXPECT_EQ(accessor.stride, 12U);
  EXPECT_THAT(accessor.actual_max, ElementsAre(0.25, 0, 0));
  EXPECT_FALSE(survey.primitives[0].targets.at(1).at(0).accessor.is_meshopt);
}

TEST(MeshSurvey, HasTheChannelsOfItsNode) {
  const MeshSurvey survey = survey_mesh(MorphFile().open());
  ASSERT_EQ(survey.channels.size(), 1U);
  EXPECT_EQ(survey.channels[0].animation_name, "Play");
  EXPECT_EQ(survey.channels[0].pointer, "/animations/0/samplers/0");
  EXPECT_THAT(survey.channels[0].curve.times, ElementsAre(0, 0.5, 1));
  EXPECT_EQ(survey.name_count, 2U);
}

TEST(MeshSurvey, RefusesAnimationsThatMultiplySharedBytes) {
  MorphFile file(1);
  std::vector<double> times(200000);
  for (std::size_t k = 0; k < times.size(); ++k) times[k] = static_cast<double>(k);
  file.set_weights(times, std::vector<double>(times.size(), 0));
  for (int i = 0; i < 100; ++i) {
    file.draft.json["animations"].push_back(Json(file.draft.json["animations"][0]));
  }
  try {
    survey_mesh(file.open());
    ADD_FAILURE() << "it was read";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems()[0].code, "gltf.too-large");
  }
}

TEST(MeshSurvey, RefusesMoreMeshesThanAreLookedAt) {
  MorphFile file(1);
  Json& json = file.draft.json;
  for (int i = 1; i <= 256; ++i) {
    json["meshes"].push_back(Json(json["meshes"][0]));
    json["nodes"].push_back({{"mesh", i}});
    json["scenes"][0]["nodes"].push_back(i);
  }
  EXPECT_THROW(survey_meshes(file.open()), BakeError);
  EXPECT_EQ(survey_meshes(file.open(), {.node = 7}).size(), 1U);
}

}  // namespace
}  // namespace morphbake
