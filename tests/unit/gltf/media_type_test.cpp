#include "morphbake/gltf/media_type.h"

#include <gtest/gtest.h>

namespace morphbake {
namespace {

std::string of_bytes(std::string_view bytes) { return media_type(bytes, {"", "", ""}); }

TEST(MediaType, NothingIsCertainOfUnknownBytes) {
  EXPECT_EQ(of_bytes(""), "application/octet-stream");
  EXPECT_EQ(of_bytes("RIFF"), "application/octet-stream");
  EXPECT_EQ(of_bytes("RIFF....WAVE"), "application/octet-stream");
  EXPECT_EQ(media_type("?", {"", "", "folder.png/picture"}), "application/octet-stream");
}

TEST(MediaType, BytesSayWhatTheyAre) {
  EXPECT_EQ(of_bytes("\x89PNG\r\n\x1a\n"), "image/png");
  EXPECT_EQ(of_bytes("\xFF\xD8\xFF\xE0"), "image/jpeg");
  EXPECT_EQ(of_bytes("RIFF....WEBPVP8 "), "image/webp");
  EXPECT_EQ(of_bytes("\xABKTX 20\xBB\r\n"), "image/ktx2");
  EXPECT_EQ(of_bytes("DDS |"), "image/vnd-ms.dds");
  EXPECT_EQ(of_bytes(std::string_view("\0\0\0\x1c"
                                      "ftypavif",
                                      12)),
            "image/avif");
}

// glTF 2.0, 3.9.3.3: of bytes and labels that differ the bytes hold.
TEST(MediaType, BytesAreBelievedBeforeLabels) {
  EXPECT_EQ(media_type("\x89PNG", {"image/jpeg", "image/webp", "a.dds"}), "image/png");
  EXPECT_EQ(media_type("?", {"image/x", "image/webp", "a.dds"}), "image/x");
  EXPECT_EQ(media_type("?", {"", "image/webp", "a.dds"}), "image/webp");
  EXPECT_EQ(media_type("?", {"", "", "a.DDS"}), "image/vnd-ms.dds");
  EXPECT_EQ(media_type("?", {"", "", "a/b.jpeg"}), "image/jpeg");
}

}  // namespace
}  // namespace morphbake
