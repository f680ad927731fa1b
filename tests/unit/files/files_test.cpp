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
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "inner");
  }

  ~Files() override { fs::remove_all(folder_); }

  void write(const fs::path& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  std::string code_of_reading(const fs::path& name, std::uintmax_t limit) const {
    try {
      read_file(folder_ / name, limit);
    } catch (const BakeError& error) {
      return error.problems().front().code;
    }
    return "";
  }

  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(folder_), {}));
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Files, ReadingTellsWhatIsWrong) {
  write("big", "12345");
  EXPECT_EQ(code_of_reading("gone", 10), "files.missing");
  EXPECT_EQ(code_of_reading("inner", 10), "files.not-a-file");
  EXPECT_EQ(code_of_reading("big", 4), "files.too-large");
  EXPECT_EQ(read_file(folder_ / "big", 5), "12345");
}

TEST_F(Files, NothingLeavesTheFolder) {
  fs::create_symlink("/etc", folder_ / "link");
  for (const char* uri :
       {"", "/etc/passwd", "../x", "inner/../../x", "http://x/y", "data:,x", "link/passwd"}) {
    EXPECT_EQ(inside_folder(folder_, uri), fs::path()) << uri;
  }
  EXPECT_EQ(inside_folder(folder_, "inner/./a.bin"), fs::canonical(folder_) / "inner/a.bin");
  EXPECT_EQ(inside_folder(folder_, "..a"), fs::canonical(folder_) / "..a");
}

TEST_F(Files, WhatIsNotCommittedIsGone) {
  const std::size_t before = entries();
  {
    PendingOutputs outputs;
    const fs::path temporary = outputs.stage(folder_ / "new/deep/out.glb", "abc");
    EXPECT_EQ(temporary.extension(), ".glb");
    EXPECT_EQ(read_file(temporary, 10), "abc");
    EXPECT_FALSE(fs::exists(folder_ / "new/deep/out.glb"));
  }
  EXPECT_EQ(entries(), before);
}

TEST_F(Files, CommitReplacesAtOnce) {
  write("out.txt", "old");
  PendingOutputs outputs;
  outputs.stage(folder_ / "out.txt", "new");
  outputs.stage(folder_ / "more/out.txt", "more");
  EXPECT_EQ(read_file(folder_ / "out.txt", 10), "old");
  outputs.commit();
  EXPECT_EQ(read_file(folder_ / "out.txt", 10), "new");
  EXPECT_EQ(read_file(folder_ / "more/out.txt", 10), "more");
}

TEST_F(Files, UnwritablePlacesAreTold) {
  write("file", "");
  PendingOutputs outputs;
  EXPECT_THROW(outputs.stage(folder_ / "file/out.glb", "x"), BakeError);
  EXPECT_THROW(outputs.stage(folder_ / "inner", "x"), BakeError);
}

}  // namespace
}  // namespace morphbake
