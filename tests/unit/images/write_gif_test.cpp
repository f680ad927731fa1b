#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/images/images.h"
#include "tests/unit/images/gif_reader.h"
#include "tests/unit/images/pictures.h"

namespace morphbake {
namespace {

std::string written(const std::vector<Image>& frames, double frames_per_second) {
  const auto file = std::filesystem::path(testing::TempDir()) / "write_gif_test.gif";
  write_gif(file, frames, frames_per_second);
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  std::filesystem::remove(file);
  return bytes.str();
}

/// A bright square that moves over a still grey gradient.
std::vector<Image> moving_square(int count) {
  std::vector<Image> frames;
  for (int i = 0; i < count; ++i) {
    Image frame{96, 64, {}};
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 96; ++x) {
        const bool inside = std::abs(x - 20 - 5 * i) < 10 && std::abs(y - 32) < 10;
        const auto grey = static_cast<std::uint8_t>(120 + x);
        if (inside) frame.rgb.insert(frame.rgb.end(), {230, 60, 20});
        if (!inside) frame.rgb.insert(frame.rgb.end(), {grey, grey, grey});
      }
    }
    frames.push_back(frame);
  }
  return frames;
}

int largest_difference(const Image& a, const Image& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    largest = std::max(largest, std::abs(a.rgb[i] - b.rgb[i]));
  }
  return largest;
}

TEST(WriteGif, SaysThatAFolderIsMissing) {
  try {
    write_gif("/no/such/folder/loop.gif", {plain(4, 4, 1, 2, 3)}, 24);
    FAIL();
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems().front().code, "output.unwritable");
  }
}

TEST(WriteGif, LoopsForEverWithEveryFrame) {
  const PlayedGif gif = GifReader(written(moving_square(9), 24)).read();
  EXPECT_TRUE(gif.loops_for_ever);
  EXPECT_EQ(gif.frames.size(), 9u);
}

TEST(WriteGif, KeepsTheLoopsLengthInWholeHundredths) {
  const PlayedGif gif = GifReader(written(moving_square(9), 30)).read();
  EXPECT_EQ(std::accumulate(gif.delays.begin(), gif.delays.end(), 0), 30);
  for (const int delay : gif.delays) EXPECT_TRUE(delay == 3 || delay == 4);
}

TEST(WriteGif, ShowsFewColoursExactly) {
  const std::vector<Image> frames = moving_square(9);
  const PlayedGif gif = GifReader(written(frames, 24)).read();
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(gif.frames[i].rgb, frames[i].rgb);
}

TEST(WriteGif, LeavesStillPixelsStill) {
  std::vector<Image> frames{coloured_noise(64, 64), coloured_noise(64, 64)};
  frames[1].rgb[0] = static_cast<std::uint8_t>(frames[1].rgb[0] ^ 0xff);
  const PlayedGif gif = GifReader(written(frames, 24)).read();
  const auto& before = gif.frames[0].rgb;
  const auto& after = gif.frames[1].rgb;
  EXPECT_TRUE(std::equal(before.begin() + 3, before.end(), after.begin() + 3));
}

TEST(WriteGif, SurvivesManyCodes) {
  // More than 4096 different strings: the code table starts again several times.
  const PlayedGif gif = GifReader(written({coloured_noise(300, 200)}, 24)).read();
  EXPECT_LE(largest_difference(gif.frames[0], coloured_noise(300, 200)), 120);
}

TEST(WriteGif, ReadsBackAtEverySize) {
  // Some length ends exactly where a code grows by a bit.
  for (int width = 200; width < 330; ++width) {
    const PlayedGif gif = GifReader(written({coloured_noise(width, 1)}, 24)).read();
    EXPECT_EQ(gif.frames.size(), 1u) << width;
  }
}

TEST(WriteGif, IsTheSameForTheSamePixels) {
  EXPECT_EQ(written(moving_square(3), 24), written(moving_square(3), 24));
}

}  // namespace
}  // namespace morphbake
