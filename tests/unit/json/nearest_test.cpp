#include "morphbake/json/nearest.h"

#include <gtest/gtest.h>

namespace morphbake {
namespace {

TEST(NearestName, FindsSwappedMissingAndWrongLetters) {
  const std::vector<std::string> names = {"ease", "nose", "region", "smoothstep"};
  EXPECT_EQ(nearest_name("nsoe", names), "nose");
  EXPECT_EQ(nearest_name("regon", names), "region");
  EXPECT_EQ(nearest_name("SmothStep", names), "smoothstep");
}

TEST(NearestName, FindsNothingFarAway) {
  EXPECT_EQ(nearest_name("giraffe", {"ease", "nose"}), "");
  EXPECT_EQ(nearest_name("x", {"a"}), "");
  EXPECT_EQ(nearest_name("", {"a"}), "");
}

TEST(NameList, IsCutAfterADozen) {
  EXPECT_EQ(name_list(std::vector<std::string>(14, "a")),
            "a, a, a, a, a, a, a, a, a, a, a, a and 2 more");
}

TEST(NameHint, SaysWhenThereIsNothing) {
  EXPECT_EQ(name_hint("a", {}, "regions"), "there are no regions");
}

}  // namespace
}  // namespace morphbake
