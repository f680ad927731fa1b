#include <gtest/gtest.h>

#include <clocale>
#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

Problem problem_of(std::string_view text) {
  try {
    parse_json(text, "file.json");
  } catch (const BakeError& error) {
    return error.problems().front();
  }
  return {};
}

TEST(ParseJson, SyntaxErrorHasLineAndColumnInLetters) {
  const Problem problem = problem_of("{\n  \"ü\": x\n}");
  EXPECT_EQ(problem.code, "json.syntax");
  EXPECT_EQ(problem.location.line, 2);
  EXPECT_EQ(problem.location.column, 8);
}

TEST(ParseJson, QuotesNoMegabytes) {
  EXPECT_LT(problem_of("{\"" + std::string(1 << 20, 'x')).message.size(), 200U);
}

TEST(ParseJson, MegabytesOfBracketsDoNotOverflowTheStack) {
  EXPECT_EQ(problem_of(std::string(10 << 20, '[')).code, "json.too-deep");
  EXPECT_EQ(problem_of(std::string(64, '[') + std::string(64, ']')).code, "");
  EXPECT_EQ(problem_of(std::string(65, '[') + std::string(65, ']')).code, "json.too-deep");
}

TEST(ParseJson, FindsAllRepeatedFields) {
  try {
    parse_json(R"({"a": [0, {"b/": 1, "b/": 2}], "a": 3})", "file.json");
    FAIL();
  } catch (const BakeError& error) {
    ASSERT_EQ(error.problems().size(), 2U);
    EXPECT_EQ(error.problems()[0].location.pointer, "/a/1/b~1");
    EXPECT_EQ(error.problems()[1].location.pointer, "/a");
  }
}

TEST(ParseJson, RefusesWhatIsNoUtf8) {
  EXPECT_EQ(problem_of("\"\xC0\xAF\"").code, "json.syntax");
  EXPECT_EQ(problem_of("\"\xED\xA0\x80\"").code, "json.syntax");
  EXPECT_EQ(problem_of(R"("\ud800")").code, "json.syntax");
}

TEST(ParseJson, SkipsAByteOrderMark) { EXPECT_EQ(parse_json("\xEF\xBB\xBF[1]", "f")[0], 1); }

TEST(ParseJson, KeepsTheOrderOfFields) {
  EXPECT_EQ(parse_json(R"({"z": 1, "a": {"y": 2, "b": []}})", "f").dump(),
            R"({"z":1,"a":{"y":2,"b":[]}})");
}

TEST(ParseJson, IgnoresTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr) GTEST_SKIP() << "no German locale here";
  const Json json = parse_json("1.5", "f");
  const std::string text = shown(json);
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(json.get<double>(), 1.5);
  EXPECT_EQ(text, "1.5");
}

TEST(ChildPointer, EscapesTildeAndSlash) { EXPECT_EQ(child_pointer("/a", "b~/c"), "/a/b~0~1c"); }

TEST(Shown, CutsBetweenLetters) {
  std::string letters;
  for (int i = 0; i < 40; ++i) letters += "ü";
  const std::string text = shown(Json(letters));
  EXPECT_LE(text.size(), 63U);
  EXPECT_NO_THROW(Json(text).dump());
}

TEST(Shown, EscapesControlCharacters) { EXPECT_EQ(shown(Json("\x1b[31m")), "\"\\u001b[31m\""); }

}  // namespace
}  // namespace morphbake
