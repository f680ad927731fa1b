#include "morphbake/batch/report_file.h"

#include <gmock/gmock.h>

#include "morphbake/batch/batch_record.h"
#include "morphbake/batch/file_states.h"
#include "morphbake/files/files.h"
#include "morphbake/json/schema.h"
#include "unit/batch/batch_folder.h"

namespace morphbake {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

BatchRecord a_record(const std::string& name) {
  BatchRecord record;
  record.name = name;
  record.recipe = "../a.json";
  record.set = R"({"/name":"\"state\":\"failed\",","state":"failed"})";
  record.is_done = true;
  record.seconds = 0.25;
  record.summary = BakeSummary{10, 20, 30, 2, 1000, 1e-4, 0.5, {{"solve", 0.1}}, {"connectivity"}};
  record.problems = {
      {Severity::Warning, "a.b", {"list.jsonl", "/name", 3, 4}, "odd \"thing\"\n", "none"}};
  record.request = "r";
  record.key = "k";
  record.connectivity = "c";
  record.written = 1700000000123456789;
  record.inputs = {{"../a.json", true, 7, 1700000000000000001, "h"}, {"b", false, 0, 0, ""}};
  record.outputs = {{name + "/a.glb", true, 8, 2, "i"}};
  return record;
}

TEST(BatchRecord, IsNoneWhenCutOffAnywhere) {
  const std::string line = record_to_line(a_record("a"));
  for (std::size_t length = 0; length < line.size(); ++length) {
    EXPECT_FALSE(record_from_line(line.substr(0, length))) << length;
    EXPECT_EQ(start_of_line(line.substr(0, length)).name.empty() || line[length - 1] == '}', true);
  }
  for (const char* other : {"7", "{}", "[]", "null", R"({"name":"a","state":"done","recipe":1})"}) {
    EXPECT_FALSE(record_from_line(other)) << other;
  }
}

TEST(BatchRecord, IsNoneWhereANumberIsNotWholeOrDoesNotFit) {
  const std::string line = record_to_line(a_record("a"));
  const std::pair<std::string, std::vector<std::string>> changes[] = {
      {"\"vertices\":10", {"2147483648", "1e24", "1.5", "-2147483649"}},
      {"\"bytes\":1000", {"-1", "18446744073709551616"}},
      {"\"line\":3", {"1e24"}},
      {"\"mtime_ns\":2,", {"1e24,", "9223372036854775808,"}},
      {"\"written_ns\":1700000000123456789", {"1e24"}}};
  for (const auto& [part, numbers] : changes) {
    const std::size_t at = line.find(part), colon = part.find(':') + 1;
    ASSERT_NE(at, std::string::npos) << part;
    for (const std::string& number : numbers) {
      std::string other = line;
      other.replace(at + colon, part.size() - colon, number);
      EXPECT_FALSE(record_from_line(other)) << part << ": " << number;
    }
  }
}

TEST(BatchRecord, ComesBackAsItWas) {
  for (const char* name : {"a", "a/\n\"\\ \xc3\xa4"}) {
    const std::string line = record_to_line(a_record(name));
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const std::optional<BatchRecord> again = record_from_line(line);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->name, name);
    EXPECT_EQ(record_to_line(*again), line);
    EXPECT_EQ(start_of_line(line).name, name);
    EXPECT_TRUE(start_of_line(line).is_done);
  }
  BatchRecord failed = a_record("a");
  failed.is_done = false;
  EXPECT_FALSE(start_of_line(record_to_line(failed)).is_done);
}

TEST(BatchRecord, FitsItsSchema) {
  BatchRecord failed = a_record("b");
  failed.is_done = false;
  failed.summary.reset();
  failed.log = "Segmentation fault";
  for (const BatchRecord& record : {a_record("a"), failed}) {
    const Json json = parse_json(record_to_line(record), "report");
    std::string said;
    for (const Problem& problem :
         schema_problems(json, shipped_schema("batch-report.schema.json"), {"report", ""})) {
      said += format_problem(problem) + "\n";
    }
    EXPECT_EQ(said, "");
  }
}

TEST(ReportFile, SaysWhenItCannotBeWritten) {
  const test::BatchFolder folder;
  EXPECT_THAT(test::problems_of([&] { append_line(folder.path() / "none/report.jsonl", "a"); }),
              HasSubstr("[output.unwritable]"));
  std::filesystem::create_directory(folder.path() / "report.jsonl");
  EXPECT_THAT(test::problems_of([&] { make_report(folder.path() / "report.jsonl"); }),
              HasSubstr("[output.unwritable]"));
}

TEST(ReportFile, TornLinesArePassedOver) {
  const test::BatchFolder folder;
  const std::string a = record_to_line(a_record("a")), b = record_to_line(a_record("b"));
  const auto report = folder.write("report.jsonl", a + "\n" + b.substr(0, 100));
  EXPECT_THAT(ReportIndex({report}).lines_of("b"), SizeIs(0));
  EXPECT_EQ(ReportIndex({report}).broken_lines(), 1);
  append_line(report, b);
  const ReportIndex index({report});
  ASSERT_THAT(index.lines_of("b"), SizeIs(1));
  EXPECT_EQ(index.lines_of("b")[0].text, b);
  EXPECT_EQ(index.lines_of("a")[0].text, a);
  EXPECT_EQ(index.broken_lines(), 1);
}

TEST(ReportFile, TheLastLineOfANameCounts) {
  const test::BatchFolder folder;
  BatchRecord later = a_record("a");
  later.seconds = 9;
  const auto first = folder.write("report.1-of-2.jsonl", record_to_line(a_record("a")) + "\n");
  const auto second = report_file(folder.path(), {});
  append_line(second, record_to_line(a_record("a")));
  append_line(second, record_to_line(later));
  const auto lines = ReportIndex({first, second, folder.path() / "none.jsonl"}).lines_of("a");
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_EQ(lines[0].report, 1U);
  EXPECT_EQ(lines[0].text, record_to_line(later));
  EXPECT_THAT(report_files(folder.path()), testing::ElementsAre(first, second));
}

TEST(ReportFile, AppendsToWhatTookItsPlace) {
  const test::BatchFolder folder;
  const auto report = folder.write("report.jsonl", "old\n");
  replace_report(report, [](std::ostream& stream) { stream << "new\n"; });
  append_line(report, "more");
  EXPECT_EQ(read_file(report, 100), "new\nmore\n");
}

class FileStates : public testing::Test {
 protected:
  /// A file that was changed so long before it was noted.
  FileState noted(const std::string& text, std::chrono::seconds before) {
    const auto file = folder.write("a", text);
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() - before);
    written = time_now();
    FileHashes hashes;
    return state_of(file, folder.path(), hashes);
  }

  Unchanged look(const FileState& state) const {
    FileHashes hashes;
    return are_unchanged({state}, folder.path(), written, hashes);
  }

  test::BatchFolder folder;
  std::int64_t written = 0;
};

TEST_F(FileStates, AnotherSizeOrNoFileIsAChange) {
  const FileState state = noted("text", std::chrono::hours(1));
  folder.write("a", "longer text");
  EXPECT_FALSE(look(state).is_true);
  std::filesystem::remove(folder.path() / "a");
  EXPECT_FALSE(look(state).is_true);
  std::filesystem::create_directory(folder.path() / "a");
  EXPECT_FALSE(look(state).is_true);
}

TEST_F(FileStates, AnotherTimeIsNoChangeWhenTheBytesAreTheSame) {
  const FileState state = noted("text", std::chrono::hours(1));
  folder.write("a", "text");
  EXPECT_TRUE(look(state).is_true);
  EXPECT_TRUE(look(state).by_hash);
  folder.write("a", "next");
  EXPECT_FALSE(look(state).is_true);
}

TEST_F(FileStates, TimesTellWhatIsLongUnchanged) {
  const FileState state = noted("text", std::chrono::hours(1));
  EXPECT_TRUE(look(state).is_true);
  EXPECT_FALSE(look(state).by_hash);
}

TEST_F(FileStates, AChangeWithinATickOfTheClockIsSeen) {
  for (const auto before : {std::chrono::seconds(1), std::chrono::seconds(-3600)}) {
    const FileState state = noted("text", before);
    const auto time = std::filesystem::last_write_time(folder.path() / "a");
    EXPECT_TRUE(look(state).is_true);
    folder.write("a", "next");
    std::filesystem::last_write_time(folder.path() / "a", time);
    EXPECT_FALSE(look(state).is_true) << before.count();
  }
}

TEST_F(FileStates, AFileThatAppearsIsAChange) {
  FileHashes hashes;
  const FileState state = state_of(folder.path() / "a", folder.path(), hashes);
  EXPECT_FALSE(state.is_there);
  EXPECT_TRUE(look(state).is_true);
  folder.write("a", "");
  EXPECT_FALSE(look(state).is_true);
}

}  // namespace
}  // namespace morphbake
