#include "morphbake/batch/manifest.h"

#include <gmock/gmock.h>

#include "morphbake/batch/line_reader.h"
#include "unit/batch/batch_folder.h"

namespace morphbake {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// What is wrong with a list of these lines.
std::string faults(const std::string& lines) {
  const test::BatchFolder folder;
  const auto list = folder.write("list.jsonl", lines);
  return test::problems_of([&] { read_manifest(list, {}); });
}

TEST(Manifest, TellsTheLineOfBrokenJson) {
  EXPECT_THAT(faults("\"a.json\"\n\n{\"recipe\": }\n"),
              AllOf(HasSubstr("list.jsonl:3:"), HasSubstr("[json.syntax]")));
}

TEST(Manifest, TellsAllThatIsWrongAtOnce) {
  EXPECT_THAT(
      faults("7\n{\"name\": \"a\"}\n{\"recipe\": \"a.json\", \"sett\": {}}\n"
             "{\"recipe\": 1}\n{\"recipe\": \"a.json\", \"set\": []}\n"),
      AllOf(HasSubstr("list.jsonl:1: error: 7 is no recipe [batch.wrong-type]"),
            HasSubstr("list.jsonl:2: error: the line names no recipe [batch.missing-field]"),
            HasSubstr("list.jsonl#/sett:3: error"), HasSubstr("did you mean \"set\"?"),
            HasSubstr("list.jsonl#/recipe:4: error: 1 is no text [batch.wrong-type]"),
            HasSubstr("list.jsonl#/set:5: error: [] is no object [batch.wrong-type]")));
}

TEST(Manifest, RefusesNamesThatLeaveTheFolder) {
  for (const char* name : {"..", "../a", "a/../../b", "/a", ".", "a\\u0000b", "report.jsonl",
                           "report.1-of-2.jsonl", "index.html/a"}) {
    EXPECT_THAT(faults("{\"recipe\": \"a.json\", \"name\": \"" + std::string(name) + "\"}"),
                HasSubstr("[batch.bad-name]"))
        << name;
  }
  EXPECT_THAT(faults("\"../elsewhere/a.json\""), HasSubstr("give the recipe a \"name\""));
  EXPECT_THAT(faults("{\"recipe\": \"a.json\", \"name\": \"" + std::string(300, 'x') + "\"}"),
              HasSubstr("more than 255 bytes"));
}

TEST(Manifest, RefusesOneNameForTwo) {
  EXPECT_THAT(faults("\"a.json\"\n\"b.json\"\n\"./a.json\"\n"),
              AllOf(HasSubstr("list.jsonl:3:"), HasSubstr("\"a\" is the name of line 1 already"),
                    HasSubstr("[batch.duplicate-name]")));
}

TEST(Manifest, RefusesAnEndlessLine) {
  std::string endless;
  endless.resize(LineReader::kLongest + 1, 'x');
  EXPECT_THAT(faults("\"a.json\"\n\"" + endless + "\"\n\"b.json\""),
              AllOf(HasSubstr("list.jsonl:2:"), HasSubstr("[batch.line-too-long]")));
}

TEST(Manifest, RefusesWhatNamesNothing) {
  for (const char* text : {"", "\n \n"}) EXPECT_THAT(faults(text), HasSubstr("[batch.empty]"));
  const test::BatchFolder folder;
  const auto told = [&](const std::string& name) {
    return test::problems_of([&] { read_manifest(folder.path() / name, {}); });
  };
  EXPECT_THAT(told("*.json"), AllOf(HasSubstr("[batch.empty]"), HasSubstr("no file matches")));
  EXPECT_THAT(told("none.jsonl"), HasSubstr("[files.missing]"));
  EXPECT_THAT(told("."), AllOf(HasSubstr("this is a folder"), HasSubstr("**/*.json")));
  folder.write("list.txt", "\"a.json\"");
  EXPECT_THAT(told("list.txt"), HasSubstr("[batch.bad-manifest]"));
  std::filesystem::create_symlink("loop.jsonl", folder.path() / "loop.jsonl");
  EXPECT_THAT(told("loop.jsonl"), HasSubstr("[files."));
}

TEST(Manifest, StopsAtAHundredProblems) {
  std::string lines;
  for (int i = 0; i < 1000; ++i) lines += "7\n";
  const std::string told = faults(lines);
  EXPECT_THAT(told, HasSubstr("list.jsonl:100:"));
  EXPECT_THAT(told, Not(HasSubstr("list.jsonl:101:")));
}

TEST(Manifest, ReadsAList) {
  const test::BatchFolder folder;
  const auto list =
      folder.write("list.jsonl",
                   "\xef\xbb\xbf\"faces/nose.json\"\r\n\n"
                   "{\"recipe\": \"tail.json\", \"name\": \"a/\\n \\\"b\\\" \\u00e4\\u9f3b/\","
                   " \"set\": {\"/timeline/duration\": 2}}");
  const Manifest manifest = read_manifest(list, {});
  EXPECT_THAT(manifest.names, ElementsAre("faces/nose", "a/\n \"b\" \xc3\xa4\xe9\xbc\xbb"));
  EXPECT_EQ(entry_of(manifest, 0).recipe, folder.path() / "faces/nose.json");
  const BatchEntry second = entry_of(manifest, 1);
  EXPECT_EQ(second.name, manifest.names[1]);
  EXPECT_EQ(second.at.line, 3);
  ASSERT_EQ(second.changes.size(), 1U);
  EXPECT_EQ(second.changes[0].pointer, "/timeline/duration");
  EXPECT_EQ(second.changes[0].value, "2");
}

TEST(Manifest, ReadsALineOfAReport) {
  const test::BatchFolder folder;
  const auto list =
      folder.write("failures.jsonl",
                   R"({"name":"a","state":"failed","recipe":"../a.json","problems":[],"log":")" +
                       std::string(4096, 'x') + "\"}");
  const Manifest manifest = read_manifest(list, {});
  EXPECT_THAT(manifest.names, ElementsAre("a"));
  EXPECT_EQ(entry_of(manifest, 0).recipe, folder.path() / "../a.json");
}

TEST(Manifest, ReadsAPatternAndARecipe) {
  const test::BatchFolder folder;
  folder.write("b/recipe.json", "");
  folder.write("a/recipe.json", "");
  folder.write("[c]*.json", "");
  EXPECT_THAT(read_manifest(folder.path() / "*/recipe.json", {}).names,
              ElementsAre("a/recipe", "b/recipe"));
  EXPECT_THAT(read_manifest(folder.path() / "a/recipe.json", {}).names, ElementsAre("recipe"));
  EXPECT_THAT(read_manifest(folder.path() / "[c]*.json", {}).names, ElementsAre("[c]*"));
}

/// What is wrong with a table of a recipe.
std::string table_faults(const std::string& name, const std::string& text) {
  const test::BatchFolder folder;
  const auto recipe = folder.write("nose.json", "");
  const auto table = folder.write(name, text);
  return test::problems_of([&] { read_manifest(recipe, table); });
}

TEST(Table, TellsLineAndCell) {
  EXPECT_THAT(table_faults("t.csv", "name,duration\n"),
              AllOf(HasSubstr("t.csv:1:2:"), HasSubstr("[batch.bad-table]")));
  EXPECT_THAT(table_faults("t.csv", "/a,/a\n"), HasSubstr("there are two columns \"/a\""));
  EXPECT_THAT(table_faults("t.csv", "name,/a\nx,1\ny\n"),
              AllOf(HasSubstr("t.csv:3:"), HasSubstr("the row has 1 cells, the first line 2")));
  EXPECT_THAT(table_faults("t.csv", "/a\n\"1\n"), HasSubstr("a quote is never closed"));
  EXPECT_THAT(table_faults("t.csv", "/a\n\"1\" 2\n"), HasSubstr("behind a closing quote"));
  EXPECT_THAT(table_faults("t.csv", "name\nx\nx\n"),
              AllOf(HasSubstr("t.csv:3:"), HasSubstr("[batch.duplicate-name]")));
  EXPECT_THAT(table_faults("t.csv", "/a\n\xff\n"), HasSubstr("no UTF-8"));
  EXPECT_THAT(table_faults("t.csv", "/a\n"),
              AllOf(HasSubstr("[batch.empty]"), HasSubstr("write a row")));
  EXPECT_THAT(table_faults("t.csv", ""), HasSubstr("[batch.bad-table]"));
  EXPECT_THAT(table_faults("t.jsonl", "{\"a\": 1}\n"),
              AllOf(HasSubstr("t.jsonl#/a:1:"), HasSubstr("[batch.bad-table]")));
}

TEST(Table, IsOfOneRecipe) {
  const test::BatchFolder folder;
  const auto list = folder.write("list.jsonl", "\"a.json\"");
  const auto table = folder.write("t.csv", "/a\n1\n");
  EXPECT_THAT(test::problems_of([&] { read_manifest(list, table); }),
              HasSubstr("a table is of one recipe"));
}

TEST(Table, ReadsRowsAsChanges) {
  const test::BatchFolder folder;
  const auto recipe = folder.write("nose.json", "");
  const auto table = folder.write("t.csv",
                                  "\xef\xbb\xbfname,/timeline/duration,/name\r\n"
                                  "long,2.5,\"a \"\"b\"\",\nc\"\r\n"
                                  "\r\n"
                                  ",,plain\r\n");
  const Manifest manifest = read_manifest(recipe, table);
  EXPECT_THAT(manifest.names, ElementsAre("long", "nose-2"));
  const BatchEntry first = entry_of(manifest, 0);
  ASSERT_EQ(first.changes.size(), 2U);
  EXPECT_EQ(first.changes[0].value, "2.5");
  EXPECT_EQ(first.changes[1].value, R"("a \"b\",\nc")");
  EXPECT_EQ(first.changes[1].at.line, 2);
  EXPECT_EQ(first.changes[1].at.column, 3);
  const BatchEntry second = entry_of(manifest, 1);
  ASSERT_EQ(second.changes.size(), 1U);
  EXPECT_EQ(second.changes[0].pointer, "/name");
  EXPECT_EQ(second.at.line, 5);
}

TEST(Table, ReadsLinesOfObjects) {
  const test::BatchFolder folder;
  const auto recipe = folder.write("nose.json", "");
  const auto table = folder.write("t.jsonl", "{\"/a\": [1, 2]}\n{\"name\": \"x\"}\n");
  const Manifest manifest = read_manifest(recipe, table);
  EXPECT_THAT(manifest.names, ElementsAre("nose-1", "x"));
  EXPECT_EQ(entry_of(manifest, 0).recipe, recipe);
  EXPECT_EQ(entry_of(manifest, 0).changes.at(0).value, "[1,2]");
}

}  // namespace
}  // namespace morphbake
