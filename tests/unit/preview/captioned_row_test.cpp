#include "morphbake/preview/captioned_row.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "morphbake/images/drawing.h"

namespace morphbake {
namespace {

constexpr std::array<std::uint8_t, 3> kRed{200, 0, 0};
constexpr std::array<std::uint8_t, 3> kBlue{0, 0, 200};

std::vector<std::uint8_t> pixel(const Image& image, int x, int y) {
  const auto at = image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x);
  return {at, at + 3};
}

/// Dark pixels of the strip above the pictures, between two columns.
int ink(const Image& row, int strip, int from, int to) {
  int count = 0;
  for (int y = 0; y < strip; ++y) {
    for (int x = from; x < to; ++x) count += pixel(row, x, y)[0] < 100 ? 1 : 0;
  }
  return count;
}

TEST(CaptionedRow, KeepsEveryPixelBelowTheStrip) {
  const Image row = captioned_row({blank_image(40, 30, kRed), blank_image(40, 30, kBlue)},
                                  {"a.glb", "b.glb"}, "1.00 s");
  EXPECT_GE(row.width, 80);
  const int strip = row.height - 30;
  EXPECT_GT(strip, 7);
  const auto red = std::vector<std::uint8_t>(kRed.begin(), kRed.end());
  const auto blue = std::vector<std::uint8_t>(kBlue.begin(), kBlue.end());
  for (int y = strip; y < row.height; ++y) {
    for (int x = 0; x < 40; ++x) {
      EXPECT_EQ(pixel(row, x, y), red);
      EXPECT_EQ(pixel(row, row.width - 1 - x, y), blue);
    }
  }
}

TEST(CaptionedRow, LabelsEachPictureAndNotesTheTimeWhereThereIsRoom) {
  const auto row_of = [](int width, const std::string& label, const std::string& note) {
    const Image picture = blank_image(width, 16, kRed);
    return captioned_row({picture, picture}, {label, label}, note);
  };
  const auto strip_of = [](const Image& row) { return row.height - 16; };
  const Image plain = row_of(200, "", "");
  EXPECT_EQ(ink(plain, strip_of(plain), 0, plain.width), 0);
  const Image noted = row_of(200, "", "1.00 s");
  EXPECT_EQ(ink(noted, strip_of(noted), 0, 340), 0);
  EXPECT_GT(ink(noted, strip_of(noted), 340, noted.width), 20);
  const Image labelled = row_of(200, "a.glb", "");
  EXPECT_GT(ink(labelled, strip_of(labelled), 0, 200), 20);
  EXPECT_EQ(ink(labelled, strip_of(labelled), 0, 200), ink(labelled, strip_of(labelled), 200, 401));
  const Image narrow = row_of(60, "", "1.00 s");
  EXPECT_EQ(ink(narrow, strip_of(narrow), 0, narrow.width), 0);
}

TEST(CaptionedRow, IsMadeOfTheSmallestPicturesToo) {
  const Image row = captioned_row({blank_image(16, 16, kRed), blank_image(16, 16, kRed)},
                                  {"a long name.glb", "another one.glb"}, "1.00 s");
  EXPECT_GE(row.width, 32);
}

}  // namespace
}  // namespace morphbake
