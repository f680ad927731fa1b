#include "morphbake/batch/glob.h"

#include <gmock/gmock.h>

#include "unit/batch/batch_folder.h"

namespace morphbake {
namespace {

using testing::ElementsAre;

class Glob : public testing::Test {
 protected:
  Glob() {
    for (const char* name : {"a.json", "b.json", "b.glb", ".hidden.json", "x/a.json", "x/y/a.json",
                             ".git/a.json", "x/\xc3\xa4 '\"\n.json"}) {
      folder.write(name, "");
    }
    std::filesystem::create_directory_symlink("..", folder.path() / "x/up");
    std::filesystem::create_symlink("loop.json", folder.path() / "loop.json");
  }

  std::vector<std::string> matches(const std::string& pattern) const {
    std::vector<std::string> names;
    for (const auto& file : files_matching(folder.path() / pattern)) {
      names.push_back(file.lexically_relative(folder.path()));
    }
    return names;
  }

  test::BatchFolder folder;
};

TEST_F(Glob, FindsNothingWhereNothingIs) {
  EXPECT_THAT(matches("*.txt"), ElementsAre());
  EXPECT_THAT(matches("none/*.json"), ElementsAre());
  EXPECT_THAT(matches("[.json"), ElementsAre());
}

TEST_F(Glob, KnowsWildcardsOfShells) {
  EXPECT_THAT(matches("*.json"), ElementsAre("a.json", "b.json"));
  EXPECT_THAT(matches("?.g*"), ElementsAre("b.glb"));
  EXPECT_THAT(matches("[ab].json"), ElementsAre("a.json", "b.json"));
  EXPECT_THAT(matches(".h*.json"), ElementsAre(".hidden.json"));
  EXPECT_THAT(matches("*/a.json"), ElementsAre("x/a.json"));
}

TEST_F(Glob, StarsStandForAnyFoldersButDoNotFollowLinks) {
  EXPECT_THAT(matches("**/a.json"), ElementsAre("a.json", "x/a.json", "x/y/a.json"));
  EXPECT_THAT(matches("x/**/*.json"),
              ElementsAre("x/a.json", "x/y/a.json", "x/\xc3\xa4 '\"\n.json"));
  EXPECT_THAT(matches("**/**/y/*"), ElementsAre("x/y/a.json"));
}

TEST_F(Glob, KnowsTheFolderBeforeTheWildcards) {
  EXPECT_EQ(folder_before_wildcards("a/b/*/c.json"), "a/b");
  EXPECT_EQ(folder_before_wildcards("*.json"), "");
  EXPECT_EQ(folder_before_wildcards("/*/a"), "/");
}

}  // namespace
}  // namespace morphbake
