#include <gtest/gtest.h>

#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/images/images.h"
#include "tests/unit/images/pictures.h"

namespace morphbake {
namespace {

std::string code_of(const std::string& bytes) {
  try {
    decode_image(bytes, "hero.glb#/images/0");
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems().front().location.file, "hero.glb");
    EXPECT_EQ(error.problems().front().location.pointer, "/images/0");
    EXPECT_EQ(error.problems().front().message.find('\n'), std::string::npos);
    return error.problems().front().code;
  }
  return "";
}

void put_32(std::string& bytes, std::size_t at, unsigned value) {
  for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i) & 0xff);
}

/// A JPEG that ends after a frame header of this size.
std::string jpeg_start(unsigned width, unsigned height) {
  std::string bytes = "\xff\xd8\xff\xc2";
  for (const unsigned value : {0u, 17u, 8u, height >> 8, height & 0xff, width >> 8, width & 0xff}) {
    bytes.push_back(static_cast<char>(value));
  }
  return bytes + std::string(10, '\1');
}

TEST(DecodeImage, RefusesWhatIsNoImage) {
  EXPECT_EQ(code_of(""), "image.unreadable");
  EXPECT_EQ(code_of("GIF89a"), "image.unreadable");
  EXPECT_EQ(code_of(std::string(1000, '\0')), "image.unreadable");
}

TEST(DecodeImage, RefusesATruncatedPng) {
  const std::string bytes = encode_png(coloured_noise(40, 30));
  for (const std::size_t length : {4ul, 20ul, 30ul, 60ul, bytes.size() / 2, bytes.size() - 40}) {
    EXPECT_EQ(code_of(bytes.substr(0, length)), "image.unreadable") << length;
  }
}

TEST(DecodeImage, RefusesADamagedPng) {
  std::string bytes = encode_png(coloured_noise(40, 30));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  EXPECT_EQ(code_of(bytes), "image.unreadable");
}

TEST(DecodeImage, RefusesHugeSidesBeforeItAllocates) {
  std::string wide = encode_png(coloured_noise(4, 4));
  put_32(wide, 16, 16385);
  EXPECT_EQ(code_of(wide), "image.too-large");
  put_32(wide, 16, 0xffffffffu);
  EXPECT_EQ(code_of(wide), "image.too-large");
  EXPECT_EQ(code_of(jpeg_start(65535, 65535)), "image.too-large");
  EXPECT_EQ(code_of(jpeg_start(16000, 16000)),
            "image.too-large");  // the sides are not, all pixels are
}

TEST(DecodeImage, RefusesAPngThatIsTooShortForItsSize) {
  std::string bytes = encode_png(coloured_noise(4, 4));
  put_32(bytes, 16, 8000);
  put_32(bytes, 20, 8000);
  testing::internal::CaptureStderr();
  EXPECT_EQ(code_of(bytes), "image.unreadable");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // libpng has not seen it
  const Image flat{4000, 4000, std::vector<std::uint8_t>(48000000, 7)};
  EXPECT_EQ(decode_image(encode_png(flat), "flat").rgb,
            flat.rgb);  // packed nearly as far as can be
}

TEST(DecodeImage, RefusesEmptyAndCutJpegs) {
  EXPECT_EQ(code_of(jpeg_start(0, 10)), "image.unreadable");
  EXPECT_EQ(code_of(jpeg_start(10, 10)), "image.unreadable");
  EXPECT_EQ(code_of("\xff\xd8\xff\xe0"), "image.unreadable");
}

TEST(DecodeImage, GivesBackTheEncodedPixels) {
  const Image image = coloured_noise(37, 23);
  const Image decoded = decode_image(encode_png(image), "picture");
  EXPECT_EQ(decoded.width, 37);
  EXPECT_EQ(decoded.height, 23);
  EXPECT_EQ(decoded.rgb, image.rgb);
}

TEST(DecodeImage, ReadsAJpeg) {
  const Image image = decode_image(grey_jpeg(), "grey.jpg");
  ASSERT_EQ(image.width, 8);
  ASSERT_EQ(image.height, 8);
  ASSERT_EQ(image.rgb.size(), 8u * 8 * 3);
  for (const std::uint8_t value : image.rgb) EXPECT_NEAR(value, 128, 1);
}

TEST(EncodePng, IsTheSameForTheSamePixels) {
  EXPECT_EQ(encode_png(coloured_noise(20, 10)), encode_png(coloured_noise(20, 10)));
}

TEST(EncodePng, HoldsNeitherTimeNorText) {
  const std::string bytes = encode_png(coloured_noise(20, 10));
  for (const char* chunk : {"tIME", "tEXt", "iTXt", "zTXt", "eXIf"}) {
    EXPECT_EQ(bytes.find(chunk), std::string::npos) << chunk;
  }
}

}  // namespace
}  // namespace morphbake
