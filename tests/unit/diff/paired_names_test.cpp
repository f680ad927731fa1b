#include "morphbake/diff/paired_names.h"

#include <gmock/gmock.h>

namespace morphbake {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST(PairedNames, GoTogetherByNameThenInOrder) {
  const NamePairs found = paired_names({"walk", "", "run"}, {"run", "jump", "walk", "sit"});
  EXPECT_THAT(found.pairs, ElementsAre(Pair(0, 2), Pair(1, 1), Pair(2, 0)));
  EXPECT_THAT(found.only_a, IsEmpty());
  EXPECT_THAT(found.only_b, ElementsAre(3));
}

TEST(PairedNames, ThatStandTwiceGoInOrder) {
  const NamePairs found = paired_names({"x", "x", "y"}, {"y", "x"});
  EXPECT_THAT(found.pairs, ElementsAre(Pair(0, 1), Pair(2, 0)));
  EXPECT_THAT(found.only_a, ElementsAre(1));
}

TEST(PairedNames, OfNothingAreNone) {
  EXPECT_THAT(paired_names({}, {}).pairs, IsEmpty());
  EXPECT_THAT(paired_names({"a"}, {}).only_a, ElementsAre(0));
}

}  // namespace
}  // namespace morphbake
