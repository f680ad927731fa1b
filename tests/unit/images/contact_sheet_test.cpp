#include <gtest/gtest.h>

#include <algorithm>

#include "morphbake/images/images.h"
#include "tests/unit/images/pictures.h"

namespace morphbake {
namespace {

TEST(ScaleDown, IsTheIdentityAtTheSameSize) {
  const Image image = coloured_noise(13, 7);
  EXPECT_EQ(scale_down(image, 13, 7).rgb, image.rgb);
}

TEST(ScaleDown, AveragesLight) {
  Image image = plain(2, 1, 0, 0, 0);
  std::fill_n(image.rgb.begin(), 3, std::uint8_t{255});
  // Half the light of white is 188 in sRGB, not 128.
  EXPECT_EQ(scale_down(image, 1, 1).rgb, (std::vector<std::uint8_t>{188, 188, 188}));
}

TEST(ScaleDown, KeepsAPlainColourAtAnyRatio) {
  const Image small = scale_down(plain(17, 11, 200, 100, 50), 5, 3);
  EXPECT_EQ(small.rgb, plain(5, 3, 200, 100, 50).rgb);
}

TEST(ContactSheet, LaysFramesOutRowByRow) {
  const std::vector<Image> frames{plain(96, 48, 255, 0, 0), plain(96, 48, 0, 255, 0),
                                  plain(96, 48, 0, 0, 255)};
  const Image sheet = contact_sheet(frames, 2, 48);
  // Two columns of 48 and two rows of 24 with gaps of 1.
  ASSERT_EQ(sheet.width, 99);
  ASSERT_EQ(sheet.height, 51);
  const auto pixel = [&](int x, int y) {
    const auto at = sheet.rgb.begin() + (y * sheet.width + x) * 3;
    return std::vector<std::uint8_t>(at, at + 3);
  };
  EXPECT_EQ(pixel(1, 1), (std::vector<std::uint8_t>{255, 0, 0}));
  EXPECT_EQ(pixel(50, 1), (std::vector<std::uint8_t>{0, 255, 0}));
  EXPECT_EQ(pixel(1, 26), (std::vector<std::uint8_t>{0, 0, 255}));
  EXPECT_EQ(pixel(98, 50),
            (std::vector<std::uint8_t>{255, 0, 0}));  // empty cell: the first's border
}

TEST(ContactSheet, NeverScalesUp) {
  const Image sheet = contact_sheet({plain(10, 10, 9, 9, 9)}, 6, 500);
  EXPECT_EQ(sheet.width, 12);
  EXPECT_EQ(sheet.height, 12);
}

}  // namespace
}  // namespace morphbake
