#include <gmock/gmock.h>

#include "unit/recipe/recipe_folder.h"

namespace morphbake {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RecipeChanges : public testing::Test {
 protected:
  RecipeChanges() {
    recipe = folder.write("recipe.json", R"({"version": 1, "name": "morph",
      "sources": {"a": "a.glb", "b": "b.glb"},
      "timeline": {"tracks": [{"name": "all", "to": "b", "begin": 0, "end": 1}]}})");
  }

  Recipe changed(const std::string& pointer, const std::string& value) const {
    return read_recipe(recipe,
                       {{pointer, value, {(folder.path / "list.jsonl").string(), "", 7, 0}}});
  }

  std::string told(const std::string& pointer, const std::string& value = "1") const {
    try {
      changed(pointer, value);
    } catch (const BakeError& error) {
      return error.what();
    }
    return "";
  }

  test::RecipeFolder folder;
  std::filesystem::path recipe;
};

TEST_F(RecipeChanges, TellWhoAsksForWhatCannotBe) {
  EXPECT_THAT(told("/timeline/tracks/0/end", "\"late\""),
              AllOf(HasSubstr("list.jsonl#/timeline/tracks/0/end:7: error:"),
                    HasSubstr("[recipe.wrong-type]")));
  EXPECT_THAT(told("/timeline/tracks/0/end", "-1"),
              HasSubstr("list.jsonl#/timeline/tracks/0/end:7"));
  EXPECT_THAT(
      told("/timeline/tracks/0/to", "\"c\""),
      AllOf(HasSubstr("list.jsonl#/timeline/tracks/0/to:7"), HasSubstr("[recipe.unknown-name]")));
  EXPECT_THAT(told("/timelin/duration"),
              AllOf(HasSubstr("list.jsonl#/timelin:7"), HasSubstr("[recipe.unknown-field]")));
  EXPECT_THAT(told("/sources/b", "\"c.glb\""),
              AllOf(HasSubstr("list.jsonl#/sources/b:7"), HasSubstr("[recipe.missing-file]")));
}

TEST_F(RecipeChanges, TellPointersThatNameNothing) {
  for (const char* pointer : {"", "/", "timeline", "/timeline/tracks/1", "/timeline/tracks/-",
                              "/timeline/tracks/end", "/name/first", "/a~2b", "/include/0"}) {
    EXPECT_THAT(told(pointer),
                HasSubstr(std::string(pointer) == "/" ? "7: error" : "[recipe.bad-pointer]"))
        << pointer;
  }
}

TEST_F(RecipeChanges, AreMadeInPlaceOfWhatIsThere) {
  EXPECT_EQ(changed("/timeline/tracks/0/end", "3").timeline.tracks[0].end, 3);
  EXPECT_EQ(changed("/timeline/duration", "4").timeline.duration, 4);
  EXPECT_EQ(changed("/name", "\"other\"").name, "other");
  EXPECT_EQ(changed("/options/basis/easing_tolerance", "1e-7").options,
            R"({"basis":{"easing_tolerance":1e-07}})");
}

TEST_F(RecipeChanges, NameFilesFromTheirOwnFolder) {
  std::filesystem::create_directories(folder.path / "lists");
  folder.write("lists/c.glb", "");
  const Recipe read = read_recipe(
      recipe, {{"/sources/b", "\"c.glb\"", {(folder.path / "lists/l.jsonl").string(), ""}}});
  EXPECT_EQ(read.sources[1].file, folder.path / "lists/c.glb");
}

}  // namespace
}  // namespace morphbake
