#include "morphbake/recipe/read_recipe.h"

#include <gtest/gtest.h>

#include "morphbake/atlas/atlas.h"
#include "morphbake/connectivity/remesh_options.h"
#include "morphbake/json/explain.h"
#include "morphbake/json/schema.h"
#include "recipe_folder.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

std::string with_timeline(const std::string& timeline, const std::string& more = "") {
  return R"({"version": 1, "name": "n", "sources": {"a": "a.glb", "b": "b.glb"}, "timeline": )" +
         timeline + more + "}";
}

const std::string one_track = R"({"tracks": [{"to": "b", "begin": 0, "end": 2}]})";

TEST(ReadRecipe, FillsInTheDefaultsOfTheSchema) {
  const test::RecipeFolder folder;
  const Recipe recipe = folder.read(with_timeline(
      one_track,
      R"(, "regions": {"r": {"ball": {"on": "a", "at": "nose", "inner": 0, "outer": 1}}},
          "connectivity": {"mode": "resample", "texture": {"of": "b"}}, "preview": {}, "states": {"s": {"mix": "a", "edits": [{"to": "b"}]}})"));
  const Json schema = shipped_schema("recipe.schema.json");
  const auto by_default = [&](const std::string& pointer) {
    const Json& node = schema.at(Json::json_pointer(pointer));
    return node.contains("default") ? node["default"] : referred(schema, node)["default"];
  };
  EXPECT_EQ(by_default("/properties/units"), "diagonal");
  EXPECT_EQ(recipe.units, Units::Diagonal);
  const std::string connectivity = "/definitions/connectivity/properties/";
  EXPECT_EQ(by_default(connectivity + "mode"), "shared");
  EXPECT_EQ(ConnectivityRequest{}.mode, ConnectivityMode::Shared);
  const RemeshOptions options;
  EXPECT_EQ(recipe.connectivity.max_error, options.max_error);
  EXPECT_EQ(by_default(connectivity + "max_error"), options.max_error);
  EXPECT_EQ(recipe.connectivity.max_vertices, options.max_vertices);
  EXPECT_EQ(by_default(connectivity + "max_vertices"), options.max_vertices);
  EXPECT_EQ(recipe.connectivity.target_edge_length, options.target_edge_length);
  EXPECT_EQ(by_default(connectivity + "target_edge_length"), options.target_edge_length);
  EXPECT_EQ(by_default(connectivity + "sizing"), "curvature");
  EXPECT_EQ(recipe.connectivity.sizing, VertexSizing::Curvature);
  EXPECT_EQ(options.sizing, Sizing::Curvature);
  const AtlasOptions atlas;
  ASSERT_TRUE(recipe.connectivity.texture);
  EXPECT_EQ(recipe.connectivity.texture->of, 1);
  EXPECT_EQ(recipe.connectivity.texture->size, atlas.size);
  EXPECT_EQ(by_default(connectivity + "texture/properties/size"), atlas.size);
  EXPECT_EQ(recipe.connectivity.texture->padding, atlas.padding);
  EXPECT_EQ(by_default(connectivity + "texture/properties/padding"), atlas.padding);
  EXPECT_EQ(by_default("/definitions/timeline/properties/fps"), recipe.timeline.frames_per_second);
  EXPECT_EQ(by_default("/definitions/track/properties/amount"),
            recipe.timeline.tracks[0].edit.amount);
  EXPECT_EQ(by_default("/definitions/edit/properties/amount"), recipe.states[0].edits[0].amount);
  EXPECT_EQ(by_default("/definitions/track/properties/ease"), "smoothstep");
  EXPECT_EQ(recipe.timeline.tracks[0].ease.kind, Ease::Smoothstep);
  EXPECT_EQ(by_default("/definitions/key/properties/ease"), "linear");
  EXPECT_EQ(Key{}.ease.kind, Ease::Linear);
  EXPECT_EQ(by_default("/definitions/region/properties/ball/properties/distance"), "geodesic");
  EXPECT_EQ(std::get<BallRegion>(recipe.regions[0].shape).distance, DistanceMeasure::Geodesic);
  EXPECT_EQ(by_default("/definitions/output/properties/targets"), "auto");
  EXPECT_EQ(recipe.outputs[0].targets, TargetKind::Auto);
  const std::string preview = "/definitions/preview/properties/";
  EXPECT_EQ(by_default(preview + "turntable/properties/size"),
            Json({recipe.preview->width, recipe.preview->height}));
  EXPECT_EQ(by_default(preview + "turntable/properties/frames"), recipe.preview->frames);
  EXPECT_EQ(by_default(preview + "formats"), Json({"gif", "sheet"}));
  EXPECT_EQ(recipe.preview->formats, (std::vector{PreviewFormat::Gif, PreviewFormat::Sheet}));
}

TEST(ReadRecipe, WithoutOutputsWritesItsNameWithoutPreview) {
  const test::RecipeFolder folder;
  const Recipe recipe = folder.read(with_timeline(one_track));
  ASSERT_EQ(recipe.outputs.size(), 1U);
  EXPECT_EQ(recipe.outputs[0].file, fs::canonical(folder.path) / "n.glb");
  EXPECT_FALSE(recipe.preview.has_value());
  EXPECT_EQ(recipe.options, "{}");
  EXPECT_EQ(recipe.timeline.start, (Shares{{1}, {0}}));
}

TEST(ReadRecipe, ResolvesNamesToIndices) {
  const test::RecipeFolder folder;
  const Recipe recipe = folder.read(with_timeline(
      R"({"start": {"a": 0.25, "b": 0.75}, "tracks": [
          {"region": "rest", "to": {"b": 1}, "begin": 0, "end": 1}]})",
      R"(, "regions": {"rest": {"rest_of": ["nose"]},
          "nose": {"ball": {"on": "a", "at": "nose", "inner": 0.1, "outer": 0.2}}})"));
  EXPECT_EQ(std::get<CombinedRegion>(recipe.regions[0].shape).regions, std::vector<int>{1});
  const Place& centre = std::get<BallRegion>(recipe.regions[1].shape).centre;
  EXPECT_EQ(std::get<Eigen::Vector3d>(centre), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(recipe.timeline.tracks[0].edit.region, 0);
  EXPECT_EQ(recipe.timeline.tracks[0].edit.to, (Shares{{0}, {1}}));
  EXPECT_EQ(recipe.timeline.tracks[0].name, "rest");
  EXPECT_EQ(recipe.timeline.start, (Shares{{0.25}, {0.75}}));
}

TEST(ReadRecipe, ASourceChoosesByNameOrIndex) {
  const test::RecipeFolder folder;
  const Recipe recipe = folder.read(
      R"({"version": 1, "name": "n", "sources": {
          "a": {"file": "a.glb", "node": "Body", "animation": {"time": 0.5}},
          "b": {"file": "b.glb", "mesh": 2, "target": "2"}}, "timeline": )" +
      one_track + "}");
  const MeshChoice &a = recipe.sources[0].choice, &b = recipe.sources[1].choice;
  EXPECT_EQ(a.node, NameOrIndex("Body"));
  EXPECT_FALSE(is_chosen(a.mesh) || is_chosen(a.target));
  ASSERT_TRUE(a.moment);
  EXPECT_FALSE(is_chosen(a.moment->animation));
  EXPECT_EQ(a.moment->time, 0.5);
  EXPECT_EQ(b.mesh, NameOrIndex(2));
  EXPECT_EQ(b.target, NameOrIndex("2"));  // a name, although it looks like an index
  EXPECT_FALSE(b.moment);
}

TEST(ReadRecipe, TracksMayReferToLaterOnes) {
  const test::RecipeFolder folder;
  const Timeline timeline = folder
                                .read(with_timeline(R"({"tracks": [
      {"name": "x", "to": "b", "begin": {"after": "y", "delay": 0.5}, "duration": 1},
      {"name": "y", "to": "b", "begin": {"with": "z", "delay": 0.25}, "duration": 1},
      {"name": "z", "to": "b", "begin": 0.5, "end": 4}]})"))
                                .timeline;
  EXPECT_EQ(timeline.tracks[1].begin, 0.75);
  EXPECT_EQ(timeline.tracks[0].begin, 2.25);
  EXPECT_EQ(timeline.tracks[0].end, 3.25);
  EXPECT_EQ(timeline.duration, 4);
}

TEST(ReadRecipe, ASourceIsAStateAndKeysRestUntilTheDuration) {
  const test::RecipeFolder folder;
  const Recipe recipe = folder.read(with_timeline(
      R"({"duration": 3, "keys": [{"time": 0, "state": "a"}, {"time": 1, "state": "half"},
                                  {"time": 2, "state": "a", "ease": "cubic"}]})",
      R"(, "states": {"half": {"mix": {"a": 0.5, "b": 0.5}}})"));
  ASSERT_EQ(recipe.states.size(), 2U);
  EXPECT_EQ(recipe.states[1].name, "a");
  EXPECT_EQ(recipe.states[1].mix, (Shares{{1}, {0}}));
  const std::vector<Key>& keys = recipe.timeline.keys;
  ASSERT_EQ(keys.size(), 4U);
  EXPECT_EQ(keys[0].state, 1);
  EXPECT_EQ(keys[1].state, 0);
  EXPECT_EQ(keys[2].ease.kind, Ease::Cubic);
  EXPECT_EQ(keys[3].time, 3);
  EXPECT_EQ(keys[3].state, 1);
  EXPECT_EQ(recipe.timeline.duration, 3);
}

TEST(ReadRecipe, StillsNameATimeAStateOrASource) {
  const test::RecipeFolder folder;
  const Recipe recipe =
      folder.read(with_timeline(one_track, R"(, "outputs": [{"file": "x.glb", "still": {"at": 1.5}},
                                   {"file": "out/y.glb", "still": {"at": "b"}}])"));
  EXPECT_EQ(std::get<double>(recipe.outputs[0].still->at), 1.5);
  EXPECT_EQ(std::get<int>(recipe.outputs[1].still->at), 0);
  EXPECT_EQ(recipe.states[0].mix, (Shares{{0}, {1}}));
}

TEST(ReadRecipe, SourcesMayBeAnywhereAndHaveAnyName) {
  const test::RecipeFolder folder;
  folder.write("über uns/長頸鹿 (1).glb", "");
  folder.write("über uns/長頸鹿 (1).landmarks.json",
               R"({"version": 1, "landmarks": {"鼻": {"position": [1, 2, 3]}}})");
  folder.write("recipes/recipe.json", "");
  const fs::path file = folder.write(
      "recipes/rezept größe.json",
      R"({"version": 1, "name": "キリン", "sources": {"長頸鹿": "../über uns/長頸鹿 (1).glb", "b": ")" +
          (folder.path / "b.glb").string() +
          R"("}, "timeline": {"tracks": [{"to": "b", "begin": 0, "end": 1}]}})");
  const Recipe recipe = read_recipe(file);
  EXPECT_EQ(recipe.sources[0].file, folder.path / "über uns/長頸鹿 (1).glb");
  EXPECT_EQ(recipe.sources[0].landmarks[0].name, "鼻");
  EXPECT_EQ(recipe.sources[1].file, folder.path / "b.glb");
}

TEST(ReadRecipe, LandmarksMayStandInline) {
  const test::RecipeFolder folder;
  const Recipe recipe = folder.read(
      R"({"version": 1, "name": "n", "timeline": )" + one_track +
      R"(, "sources": {"a": {"file": "a.glb", "landmarks": {"tip": {"position": [1, 2, 3]}}},
                        "b": "b.glb"}})");
  ASSERT_EQ(recipe.sources[0].landmarks.size(), 1U);
  EXPECT_EQ(recipe.sources[0].landmarks[0].name, "tip");
}

TEST(ReadRecipe, NamesSumsAndFilesAreReportedWithUnknownFields) {
  const test::RecipeFolder folder;
  const std::string said = folder.problems(folder.write(
      "r.json", with_timeline(R"({"fsp": 1, "tracks": [{"to": "c", "begin": 0, "edn": 2}]})")));
  EXPECT_NE(said.find("unknown field \"fsp\""), std::string::npos);
  EXPECT_NE(said.find("there is no source \"c\""), std::string::npos);
  EXPECT_EQ(said.find("when does this track end"), std::string::npos)
      << "edn explains it: " << said;
}

TEST(ReadRecipe, OutputsMayNotLeaveByALink) {
  const test::RecipeFolder folder;
  fs::create_directory_symlink(fs::temp_directory_path(), folder.path / "link");
  const std::string said = folder.problems(
      folder.write("r.json", with_timeline(one_track, R"(, "outputs": [{"file": "link/x.glb"}])")));
  EXPECT_NE(said.find("[recipe.outside-folder]"), std::string::npos) << said;
}

TEST(ReadRecipe, ListsAHundredProblemsAtMost) {
  const test::RecipeFolder folder;
  std::string tracks;
  for (int i = 0; i < 1000; ++i) {
    tracks += (i == 0 ? "" : ",") + std::string(R"({"name": "t)") + std::to_string(i) +
              R"(", "region": "x", "to": "y", "begin": {"after": "z"}, "end": 1})";
  }
  const auto file = folder.write("r.json", with_timeline("{\"tracks\": [" + tracks + "]}"));
  try {
    read_recipe(file);
    FAIL();
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems().size(), 101U);
    EXPECT_EQ(error.problems().back().message, "and 2900 more problems");
  }
}

TEST(RedirectOutputs, WritesEachFileIntoTheFolder) {
  const test::RecipeFolder folder;
  const Recipe recipe =
      folder.read(with_timeline(one_track, R"(, "outputs": [{"file": "out/x.glb"}])"));
  const Recipe redirected = redirect_outputs(recipe, folder.path / "elsewhere");
  EXPECT_EQ(redirected.outputs[0].file, folder.path / "elsewhere/x.glb");
}

TEST(RedirectOutputs, RefusesEqualNamesAndSources) {
  const test::RecipeFolder folder;
  const Recipe recipe = folder.read(with_timeline(
      one_track,
      R"(, "outputs": [{"file": "out/b.glb"}, {"file": "x.glb"}, {"file": "out/x.glb"}])"));
  try {
    redirect_outputs(recipe, folder.path);
    FAIL();
  } catch (const BakeError& error) {
    ASSERT_EQ(error.problems().size(), 2U);
    EXPECT_EQ(error.problems()[0].code, "recipe.overwrites-source");
    EXPECT_EQ(error.problems()[1].code, "recipe.duplicate-output");
  }
}

}  // namespace
}  // namespace morphbake
