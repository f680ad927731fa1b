#include <gtest/gtest.h>

#include "recipe_folder.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

TEST(FirstRecipe, NeedsTwoSourcesThatExist) {
  const test::RecipeFolder folder;
  EXPECT_THROW(first_recipe({folder.path / "a.glb"}, folder.path / "r.json", ""), BakeError);
  EXPECT_THROW(
      first_recipe({folder.path / "a.glb", folder.path / "c.glb"}, folder.path / "r.json", ""),
      BakeError);
}

TEST(FirstRecipe, MovesTheFirstCommonLandmarkFirst) {
  const test::RecipeFolder folder;
  folder.write(
      "b.landmarks.json",
      R"({"version": 1, "landmarks": {"tail": {"position": [0, 0, 2]}, "nose": {"position": [0, 0, 3]}}})");
  const Recipe recipe = folder.read(first_recipe({folder.path / "a.glb", folder.path / "b.glb"},
                                                 folder.path / "recipe.json", ""));
  EXPECT_EQ(recipe.name, "a-to-b");
  ASSERT_EQ(recipe.timeline.tracks.size(), 2U);
  EXPECT_EQ(recipe.timeline.tracks[0].name, "nose");
  EXPECT_EQ(recipe.timeline.tracks[1].name, "rest");
  const auto& ball = std::get<BallRegion>(recipe.regions[0].shape);
  EXPECT_EQ(ball.inner, 0.05);
  EXPECT_EQ(ball.outer, 0.12);
  EXPECT_EQ(recipe.outputs[0].file.filename(), "a-to-b.glb");
  EXPECT_EQ(recipe.preview->formats.size(), 2U);
}

TEST(FirstRecipe, WithoutACommonLandmarkMovesEverything) {
  const test::RecipeFolder folder;
  const Recipe recipe = folder.read(first_recipe({folder.path / "a.glb", folder.path / "b.glb"},
                                                 folder.path / "recipe.json", ""));
  ASSERT_EQ(recipe.timeline.tracks.size(), 1U);
  EXPECT_EQ(recipe.timeline.tracks[0].edit.region, -1);
}

TEST(FirstRecipe, SaysWhatSourcesOfOtherTrianglesNeed) {
  const test::RecipeFolder folder;
  const Recipe recipe =
      folder.read(first_recipe({folder.path / "a.glb", folder.path / "b.glb"},
                               folder.path / "recipe.json", "", {true, {false, true}}));
  EXPECT_EQ(recipe.connectivity.mode, ConnectivityMode::Remesh);
  EXPECT_EQ(recipe.sources[0].align, Align::None);
  EXPECT_EQ(recipe.sources[1].align, Align::Similarity);
}

TEST(FirstRecipe, TakesAwkwardNamesAndManySources) {
  const test::RecipeFolder folder;
  std::string long_name;
  for (int i = 0; i < 40; ++i) long_name += "長";
  const std::vector<fs::path> sources = {
      folder.write("one/a:b\n.glb", ""), folder.write("two/a:b\n.glb", ""),
      folder.write(long_name + ".glb", ""), folder.write("out/.hidden", "")};
  for (const fs::path& source : sources) {
    fs::path beside = source;
    folder.write(fs::relative(beside.replace_extension(".landmarks.json"), folder.path),
                 R"({"version": 1, "landmarks": {"rest": {"position": [0, 0, 0]}}})");
  }
  fs::create_directories(folder.path / "recipes");
  const fs::path file = folder.path / "recipes/first.json";
  folder.write("recipes/first.json", first_recipe(sources, file, ""));
  // A file name with a control character is a name that a recipe may not have.
  const std::string said = folder.problems(file);
  EXPECT_NE(said.find("must be a file name"), std::string::npos) << said;
}

TEST(FirstRecipe, ManySourcesFollowEachOther) {
  const test::RecipeFolder folder;
  const std::vector<fs::path> sources = {folder.path / "a.glb", folder.write("x/a.glb", ""),
                                         folder.write("x/a:b.glb", ""), folder.path / "b.glb"};
  for (const char* name : {"x/a", "x/a:b", "b"}) {
    folder.write(std::string(name) + ".landmarks.json",
                 R"({"version": 1, "landmarks": {"nose": {"position": [0, 0, 0]}}})");
  }
  fs::create_directories(folder.path / "recipes");
  const fs::path file = folder.path / "recipes/first.json";
  folder.write("recipes/first.json", first_recipe(sources, file, ""));
  const Recipe recipe = read_recipe(file);
  ASSERT_EQ(recipe.sources.size(), 4U);
  EXPECT_EQ(recipe.sources[1].name, "a-2");
  EXPECT_EQ(recipe.sources[2].name, "a-b");
  ASSERT_EQ(recipe.timeline.tracks.size(), 4U);
  EXPECT_EQ(recipe.timeline.tracks[3].begin, recipe.timeline.tracks[2].end + 0.5);
}

}  // namespace
}  // namespace morphbake
