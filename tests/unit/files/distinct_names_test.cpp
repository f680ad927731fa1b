#include "morphbake/files/distinct_names.h"

#include <gtest/gtest.h>

namespace morphbake {
namespace {

using Names = std::vector<std::string>;

TEST(DistinctNames, AreNumberedWhereAFileIsThereTwice) {
  EXPECT_EQ(distinct_names({"a.glb", "a.glb", "a.glb"}),
            (Names{"a.glb", "a.glb (2)", "a.glb (3)"}));
  EXPECT_EQ(distinct_names({"out/a.glb", "out/a.glb"}), (Names{"a.glb", "a.glb (2)"}));
  EXPECT_EQ(distinct_names({"1/a", "1/a", "2/a"}), (Names{"1/a", "1/a (2)", "2/a"}));
  EXPECT_EQ(distinct_names({"a", "a", "a (2)"}), (Names{"a", "a (2)", "a (2) (2)"}));
}

TEST(DistinctNames, AreTheFilesOwnWhereTheseDiffer) {
  EXPECT_EQ(distinct_names({"out/a.glb", "/tmp/b.glb"}), (Names{"a.glb", "b.glb"}));
}

TEST(DistinctNames, AreTheEndsOfPathsThatDiffer) {
  EXPECT_EQ(distinct_names({"runs/1/out/a.glb", "runs/2/out/a.glb"}),
            (Names{"1/out/a.glb", "2/out/a.glb"}));
  EXPECT_EQ(distinct_names({"a.glb", "/a.glb", "b/a.glb"}), (Names{"a.glb", "/a.glb", "b/a.glb"}));
}

}  // namespace
}  // namespace morphbake
