#include "morphbake/batch/run_batch.h"

#include <gmock/gmock.h>

#include "morphbake/files/files.h"
#include "unit/batch/batch_folder.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

/// How many threads this process has: libraries have some from their start.
std::size_t thread_count() {
  std::size_t count = 0;
  for (const auto& thread : fs::directory_iterator("/proc/self/task"))
    count += thread.is_directory();
  return count;
}

class RunBatch : public testing::Test {
 protected:
  RunBatch() {
    const fs::path good = fs::path(MORPHBAKE_SOURCE_DIR) / "tests/cli/good_recipe/recipe.json";
    list = folder.write("list.jsonl",
                        "{\"recipe\": \"" + good.string() + "\", \"name\": \"good\"}\n" +
                            "{\"recipe\": \"none.json\", \"name\": \"bad\"}\n" + "{\"recipe\": \"" +
                            good.string() +
                            "\", \"name\": \"again\", \"set\": {\"/name\": \"other\"}}\n");
    options.folder = folder.path() / "out";
    options.with_previews = false;
    options.processes = 2;
    observer.on_failure = [this](const BatchRecord& record) { failed.push_back(record); };
  }

  BatchResult run() { return run_batch(read_manifest(list, {}), options, observer); }

  test::BatchFolder folder;
  fs::path list;
  BatchOptions options;
  BatchObserver observer;
  std::vector<BatchRecord> failed;
};

TEST_F(RunBatch, OneFailureLeavesTheOthers) {
  const BatchResult result = run();
  EXPECT_EQ(result.progress.total, 3U);
  EXPECT_EQ(result.progress.done, 3U);
  EXPECT_EQ(result.progress.failed, 1U);
  EXPECT_EQ(result.progress.unchanged, 0U);
  ASSERT_EQ(failed.size(), 1U);
  EXPECT_EQ(failed[0].name, "bad");
  EXPECT_EQ(failed[0].problems.at(0).code, "files.missing");
  EXPECT_TRUE(fs::exists(options.folder / "good/tetrahedra.glb"));
  EXPECT_EQ(run().progress.unchanged, 2U);
}

TEST_F(RunBatch, HasNoThreadsOfItsOwn) {
  options.cache = StageCache({folder.path() / "cache"});
  const std::size_t before = thread_count();
  run();
  EXPECT_EQ(thread_count(), before);
}

TEST_F(RunBatch, WhatIsInterruptedKeepsItsReport) {
  observer.is_cancelled = [this] { return !failed.empty(); };
  const BatchResult result = run();
  EXPECT_TRUE(result.is_interrupted);
  EXPECT_THAT(read_file(result.report, 100000),
              HasSubstr("{\"name\":\"bad\",\"state\":\"failed\""));
}

TEST_F(RunBatch, ShardsThatWereNotRunAreMissing) {
  const BatchResult result = collect_batch(read_manifest(list, {}), options, observer);
  EXPECT_EQ(result.progress.failed, 3U);
  for (const BatchRecord& record : failed) {
    EXPECT_EQ(record.problems.at(0).code, "batch.missing");
  }
}

}  // namespace
}  // namespace morphbake
