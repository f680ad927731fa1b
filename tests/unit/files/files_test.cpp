#include "morphbake/files/files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace fs = std::filesystem;

namespace {

class Files : public testing::Test {
 protected:
  Files() {
    fs::remove_all(folder);
    fs::create_directories(folder / "inner");
  }

  ~Files() override { fs::remove_all(folder); }

  void write(const fs::path& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
  }

  std::string code_of_reading(const fs::path& name, std::uintmax_t limit) const {
    try {
      read_file(folder / name, limit);
    } catch (const BakeError& error) {
      return error.problems().front().code;
    }
    return "";
  }

  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(folder), {}));
  }

  fs::path folder =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Files, ReadingTellsWhatIsWrong) {
  write("big", "12345");
  EXPECT_EQ(code_of_reading("gone", 10), "files.missing");
  EXPECT_EQ(code_of_reading("inner", 10), "files.not-a-file");
  EXPECT_EQ(code_of_reading("big", 4), "files.too-large");
  EXPECT_EQ(read_file(folder / "big", 5), "12345");
}

TEST_F(Files, OfALongFileTheStartIsRead) {
  write("text", "12345");
  EXPECT_EQ(read_file_start(folder / "text", 3), "123");
  EXPECT_EQ(read_file_start(folder / "text", 9), "12345");
  EXPECT_THROW(read_file_start(folder / "gone", 3), BakeError);
  EXPECT_THROW(read_file_start(folder / "inner", 3), BakeError);
}

TEST_F(Files, NothingLeavesTheFolder) {
  fs::create_symlink("/etc", folder / "link");
  for (const char* uri :
       {"", "/etc/passwd", "../x", "inner/../../x", "http://x/y", "data:,x", "link/passwd"}) {
    EXPECT_EQ(inside_folder(folder, uri), fs::path()) << uri;
  }
  EXPECT_EQ(inside_folder(folder, "inner/./a.bin"), fs::canonical(folder) / "inner/a.bin");
  EXPECT_EQ(inside_folder(folder, "..a"), fs::canonical(folder) / "..a");
}

TEST_F(Files, WhatIsNotCommittedIsGone) {
  const std::size_t before = entries();
  {
    PendingOutputs outputs;
    const fs::path temporary = outputs.stage(folder / "new/deep/out.glb", "abc");
    EXPECT_EQ(temporary.extension(), ".glb");
    EXPECT_EQ(read_file(temporary, 10), "abc");
    EXPECT_FALSE(fs::exists(folder / "new/deep/out.glb"));
  }
  EXPECT_EQ(entries(), before);
}

TEST_F(Files, CommitReplacesAtOnce) {
  write("out.txt", "old");
  PendingOutputs outputs;
  outputs.stage(folder / "out.txt", "new");
  outputs.stage(folder / "more/out.txt", "more");
  EXPECT_EQ(read_file(folder / "out.txt", 10), "old");
  outputs.commit();
  EXPECT_EQ(read_file(folder / "out.txt", 10), "new");
  EXPECT_EQ(read_file(folder / "more/out.txt", 10), "more");
}

TEST_F(Files, UnwritablePlacesAreTold) {
  write("file", "");
  PendingOutputs outputs;
  EXPECT_THROW(outputs.stage(folder / "file/out.glb", "x"), BakeError);
  EXPECT_THROW(outputs.stage(folder / "inner", "x"), BakeError);
}

}  // namespace
}  // namespace morphbake
