#include "morphbake/images/srgb.h"

#include <gtest/gtest.h>

#include <cmath>

namespace morphbake {
namespace {

TEST(Srgb, GivesEveryByteBack) {
  for (int i = 0; i < 256; ++i) {
    const auto value = static_cast<std::uint8_t>(i);
    EXPECT_EQ(linear_to_srgb(srgb_to_linear(value)), value);
  }
}

TEST(Srgb, ClampsWhatIsOutside) {
  EXPECT_EQ(linear_to_srgb(-1), 0);
  EXPECT_EQ(linear_to_srgb(std::nanf("")), 0);
  EXPECT_EQ(linear_to_srgb(7), 255);
}

}  // namespace
}  // namespace morphbake
