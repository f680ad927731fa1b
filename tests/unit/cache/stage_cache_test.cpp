#include "morphbake/cache/stage_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>
#include <vector>

#include "morphbake/cache/content_hash.h"
#include "morphbake/files/files.h"
#include "morphbake/files/temporary_folder.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

CacheEntry entry_with(std::size_t bytes) {
  std::string blob(bytes, '\0');
  for (std::size_t i = 0; i < bytes; ++i) blob[i] = static_cast<char>(i * i);
  return {R"({"a":[1,2.5,"x"]})", {"", blob}};
}

/// A key whose entry lies in the same folder as others of that digit.
std::string key_of(char digit, int number) {
  std::string key = content_hash(std::to_string(number));
  key[0] = digit;
  return key;
}

TEST(ContentHash, IsThatOfTheReference) {
  // `printf abc | xxhsum -H2`, xxHash 0.8.1.
  EXPECT_EQ(content_hash("abc"), "06b05ab6733a618578af5f94892f3950");
  EXPECT_EQ(content_hash(""), "99aa06d3014798d86001c324468d497f");
}

TEST(ContentHash, OfAFileIsThatOfItsBytes) {
  const TemporaryFolder folder("cache-test");
  const std::string bytes = entry_with(3'000'001).blobs[1];  // more than is read at once
  replace_unsynced(folder.path() / "f", bytes);
  EXPECT_EQ(file_hash(folder.path() / "f"), content_hash(bytes));
  EXPECT_THROW(file_hash(folder.path()), BakeError);
  EXPECT_THROW(file_hash(folder.path() / "none"), BakeError);
}

TEST(CacheEntry, ComesBackAsItWas) {
  const CacheEntry entry = entry_with(1000);
  const auto back = entry_from_bytes(entry_to_bytes(entry));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->facts, entry.facts);
  EXPECT_EQ(back->blobs, entry.blobs);
}

TEST(CacheEntry, ThatIsDamagedAnywhereIsNone) {
  const std::string bytes = entry_to_bytes(entry_with(50));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_FALSE(entry_from_bytes(bytes.substr(0, i))) << "cut off at " << i;
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(entry_from_bytes(changed)) << "a bit of byte " << i;
  }
  EXPECT_FALSE(entry_from_bytes(bytes + " "));
}

TEST(CacheEntry, WithAHashButOtherwiseWrongIsNone) {
  for (const std::string body : {"", "\n", "[]\n", "{}\n",
                                 R"({"facts":{}})"
                                 "\n",
                                 R"({"facts":{},"blobs":[1]})"
                                 "\n",
                                 R"({"facts":{},"blobs":[-1]})"
                                 "\nx",
                                 R"({"facts":{},"blobs":[18446744073709551615]})"
                                 "\nx",
                                 R"({"facts":{},"blobs":["1"]})"
                                 "\nx",
                                 R"({"facts":{},"blobs":[]})"
                                 "\nx"}) {
    const std::string bytes = "morphbake cache 1 " + content_hash(body) + "\n" + body;
    EXPECT_FALSE(entry_from_bytes(bytes)) << body;
  }
}

TEST(StageCache, WithoutAFolderKeepsNothing) {
  const StageCache none;
  none.keep(key_of('0', 1), entry_with(10));
  EXPECT_FALSE(none.is_on());
  EXPECT_FALSE(none.contains(key_of('0', 1)));
}

TEST(StageCache, ThrowsOutWhatWasUsedLeastRecently) {
  const TemporaryFolder folder("cache-test");
  const StageCache cache({folder.path() / "c", std::uintmax_t{16} * 10'000});
  // Of 1,900 bytes each, five fit into a sixteenth; the first is used again and again.
  for (int i = 0; i < 20; ++i) {
    cache.keep(key_of('7', i), entry_with(1800));
    // Times may be as coarse as 10 ms.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(cache.find(key_of('7', 0), {}));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(cache.contains(key_of('7', 0)));
  EXPECT_TRUE(cache.contains(key_of('7', 19)));
  EXPECT_FALSE(cache.contains(key_of('7', 1)));
  EXPECT_LE(cache.contents().bytes, 10'000U);
  EXPECT_GE(cache.contents().entries, 3);
}

TEST(StageCache, DoesNotKeepWhatWouldFillIt) {
  const TemporaryFolder folder("cache-test");
  const StageCache cache({folder.path() / "c", std::uintmax_t{16} * 10'000});
  cache.keep(key_of('7', 0), entry_with(1000));
  cache.keep(key_of('7', 1), entry_with(20'000));
  EXPECT_TRUE(cache.contains(key_of('7', 0)));
  EXPECT_FALSE(cache.contains(key_of('7', 1)));
}

TEST(StageCache, RemovesWhatAKilledWriterLeft) {
  const TemporaryFolder folder("cache-test");
  const StageCache cache({folder.path(), std::uintmax_t{1} << 30});
  const fs::path old = folder.path() / "7" / ".x.0123.tmp.entry";
  const fs::path young = folder.path() / "7" / ".y.0123.tmp.entry";
  replace_unsynced(old, "");
  replace_unsynced(young, "");
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(3));
  cache.keep(key_of('7', 0), entry_with(10));
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(young));
}

TEST(StageCache, TellsOfADamagedEntryAndRemovesIt) {
  const TemporaryFolder folder("cache-test");
  const StageCache cache({folder.path(), std::uintmax_t{1} << 30});
  const std::string key = key_of('a', 0);
  replace_unsynced(folder.path() / "a" / (key.substr(1) + ".entry"), "half an ent");
  std::vector<Problem> told;
  Observer observer;
  observer.on_problem = [&](const Problem& problem) { told.push_back(problem); };
  EXPECT_TRUE(cache.contains(key));
  EXPECT_FALSE(cache.find(key, observer));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].code, "cache.damaged");
  EXPECT_FALSE(cache.contains(key));
  EXPECT_FALSE(cache.find(key, observer));
  EXPECT_EQ(told.size(), 1U);
}

TEST(StageCache, IsSafeWithManyWritersAndReaders) {
  const TemporaryFolder folder("cache-test");
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      // So small that entries go while others read them.
      const StageCache cache({folder.path(), std::uintmax_t{16} * 300'000});
      Observer observer;
      observer.on_problem = [&](const Problem&) { ++wrong; };
      for (int i = 0; i < 200; ++i) {
        const int which = (i * 7 + t) % 20;
        cache.keep(key_of('3', which), entry_with(20'000 + static_cast<std::size_t>(which)));
        const auto found = cache.find(key_of('3', (which + 3) % 20), observer);
        const auto size = static_cast<std::size_t>(20'000 + (which + 3) % 20);
        if (found && found->blobs[1].size() != size) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(StageCache({folder.path(), 0}).contents().bytes, 600'000U);
}

}  // namespace
}  // namespace morphbake
