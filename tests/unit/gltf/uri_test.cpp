#include "morphbake/gltf/uri.h"

#include <gtest/gtest.h>

namespace morphbake {
namespace {

std::string text_of(const DataUri& data) { return {data.bytes.begin(), data.bytes.end()}; }

TEST(DataUri, WhatIsNeitherBase64NorEscapedIsAFault) {
  for (const char* uri :
       {"data:", "data:image/png;base64", "data:;base64,????", "data:;base64,AAAA!AAA",
        "data:;base64,AAAAA", "data:;base64,AAA A",
        "data:;base64,A===", "data:;base64,AA=", "data:;base64,AAAA=", "data:;base64,AA=A",
        "data:;base64,AA%", "data:,a%2", "data:,100%", "data:,%g0", "data:,%+1"}) {
    EXPECT_NE(read_data_uri(uri).fault, "") << uri;
  }
}

// RFC 4648, section 10.
TEST(DataUri, Base64IsReadWithAndWithoutPadding) {
  const std::pair<const char*, const char*> cases[] = {{"", ""},
                                                       {"Zg==", "f"},
                                                       {"Zm8=", "fo"},
                                                       {"Zm9v", "foo"},
                                                       {"Zg", "f"},
                                                       {"Zm8", "fo"},
                                                       {"Zm9vYg==", "foob"},
                                                       {"Zm9vYmE=", "fooba"},
                                                       {"++//", "\xFB\xEF\xFF"},
                                                       {"%2B%2B//", "\xFB\xEF\xFF"},
                                                       {"Zg%3D%3D", "f"}};
  for (const auto& [digits, bytes] : cases) {
    const DataUri data =
        read_data_uri(std::string("data:application/gltf-buffer;base64,") + digits);
    EXPECT_EQ(data.fault, "") << digits;
    EXPECT_EQ(text_of(data), bytes) << digits;
  }
}

TEST(DataUri, WithoutBase64TheDataIsPercentEncoded) {
  EXPECT_EQ(text_of(read_data_uri("data:,a+b%20c%2Cd,e;base64")), "a+b c,d,e;base64");
  EXPECT_EQ(text_of(read_data_uri("data:;base64extra,QQ==")), "QQ==");
  EXPECT_EQ(text_of(read_data_uri("data:,%00")), std::string(1, '\0'));
}

TEST(DataUri, TellsItsMediaType) {
  EXPECT_EQ(read_data_uri("data:image/webp;base64,AAAA").media_type, "image/webp");
  EXPECT_EQ(read_data_uri("DATA:Image/PNG;charset=x;BASE64,AAAA").media_type, "image/png");
  EXPECT_EQ(text_of(read_data_uri("DATA:Image/PNG;charset=x;BASE64,QQ==")), "A");
  EXPECT_EQ(read_data_uri("data:,AAAA").media_type, "");
}

TEST(DataUri, OtherUrisAreNone) {
  for (const char* uri : {"", "data", "data.bin", "dat:,", "x-data:,a"}) {
    EXPECT_FALSE(is_data_uri(uri)) << uri;
  }
}

TEST(UriPath, OnlyPercentEncodingIsUndone) {
  EXPECT_EQ(uri_path("a+b%20%C3%BC%2b.bin"), "a+b \xC3\xBC+.bin");
  EXPECT_EQ(uri_path("100%.png"), "100%.png");
  EXPECT_EQ(uri_path("%zz%4"), "%zz%4");
}

}  // namespace
}  // namespace morphbake
