#include "cli/comparison_text.h"

#include <gmock/gmock.h>

#include <cmath>

#include "morphbake/json/json.h"

namespace morphbake::cli {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A closed file whose volume halves half-way, and an open one without inner edges.
Comparison small_comparison() {
  Comparison comparison;
  comparison.times = {0, 0.25, 0.5, 0.75, 1};
  ComparedMorph& closed = comparison.morphs.emplace_back();
  closed.label = "closed.glb";
  closed.is_closed = true;
  closed.end = 1;
  closed.measures.volume = {-2, -1.5, -1, -1.5, -2};
  closed.measures.volume_change = {0, -0.25, -0.5, -0.25, 0};
  closed.measures.area = {4, 4, 3, 4, 4};
  closed.measures.area_change = {0, 0, -0.25, 0, 0};
  closed.measures.edge_length_change = {0, 0.01, 0.02, 0.125, 0};
  closed.measures.bend_change = {0, 1, 2, 30.5, 0};
  ComparedMorph open = closed;
  open.label = "a rather long name of a file.glb";
  open.is_closed = false;
  open.measures.volume.clear();
  open.measures.volume_change.clear();
  open.measures.bend_change.assign(5, std::nan(""));
  comparison.morphs.push_back(open);
  comparison.pictures = {"out/both.gif"};
  return comparison;
}

TEST(ComparisonText, TellsTheWorstOfEachMeasureWithItsTime) {
  const std::vector<std::string> lines = comparison_lines(small_comparison());
  EXPECT_THAT(lines,
              Contains(testing::AllOf(HasSubstr("volume, off"), HasSubstr(" -50.00 % at 0.50 s"),
                                      testing::EndsWith(" open"))));
  EXPECT_THAT(lines, Contains(HasSubstr("-25.00 % at 0.50 s")));
  EXPECT_THAT(lines, Contains(HasSubstr(" 12.50 % at 0.75 s")));
  EXPECT_THAT(lines, Contains(testing::AllOf(HasSubstr("30.50 deg at 0.75 s"),
                                             testing::EndsWith(" none"))));
}

TEST(ComparisonText, HasARowForEveryFourthTimeAndColumnsThatAlign) {
  const std::vector<std::string> lines = comparison_lines(small_comparison());
  const auto title = std::ranges::find(lines, "volume, % of the first frame");
  ASSERT_GE(lines.end() - title, 4);
  EXPECT_THAT(title[1], testing::EndsWith("closed.glb  a rather long name of a file.glb"));
  EXPECT_THAT(title[2], testing::AllOf(testing::StartsWith("    0.00 s"), HasSubstr(" 100.00 "),
                                       testing::EndsWith(" open")));
  EXPECT_THAT(title[3], testing::StartsWith("    1.00 s"));
  EXPECT_EQ(title[1].size(), title[2].size());
  EXPECT_EQ(title[4], "");
}

TEST(ComparisonText, IsCompleteAsJson) {
  const Json json = parse_json(comparison_json(small_comparison()), "comparison");
  EXPECT_EQ(json["times"].size(), 5U);
  EXPECT_EQ(json["pictures"][0], "out/both.gif");
  const Json& closed = json["files"][0];
  EXPECT_EQ(closed["volume"][2], -1);
  EXPECT_EQ(closed["worst"]["edge_length_change"]["deviation"], 0.125);
  EXPECT_EQ(closed["worst"]["dihedral_angle_change"]["time"], 0.75);
  const Json& open = json["files"][1];
  EXPECT_TRUE(open["volume"].is_null());
  EXPECT_TRUE(open["worst"]["volume"].is_null());
  EXPECT_TRUE(open["dihedral_angle_change"][1].is_null());
  EXPECT_TRUE(open["worst"]["dihedral_angle_change"].is_null());
}

}  // namespace
}  // namespace morphbake::cli
