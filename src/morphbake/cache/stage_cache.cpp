#include "morphbake/cache/stage_cache.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <tuple>
#include <utility>

#include "morphbake/cache/content_hash.h"
#include "morphbake/files/files.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "morphbake cache 1 ";
constexpr std::size_t kDigits = 32;
constexpr std::size_t kHeader = kMagic.size() + kDigits + 1;  // and a line break
constexpr std::uintmax_t kFolders = 16;
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 36;
constexpr const char* kEnding = ".entry";
constexpr auto kAbandoned = std::chrono::hours(1);  // nobody still writes what is older

/// A file of the cache.
struct KeptFile {
  fs::path path;
  std::uintmax_t bytes = 0;
  fs::file_time_type used;
};

bool is_being_written(const KeptFile& file) {
  return file.path.filename().string().starts_with('.');
}

/// The files of one folder, least recently used first.
std::vector<KeptFile> kept_files(const fs::path& folder) {
  std::vector<KeptFile> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;  // another process may remove it meanwhile
    if (at->path().extension() != kEnding) continue;
    KeptFile file{at->path(), at->file_size(gone), at->last_write_time(gone)};
    if (!gone) files.push_back(std::move(file));
  }
  std::ranges::sort(files, [](const KeptFile& a, const KeptFile& b) {
    return std::tie(a.used, a.path) < std::tie(b.used, b.path);
  });
  return files;
}

/// The folders in which entries are: one a first digit of keys.
std::vector<fs::path> folders_of(const fs::path& cache) {
  std::vector<fs::path> folders;
  for (const char digit : std::string_view("0123456789abcdef")) {
    folders.push_back(cache / std::string(1, digit));
  }
  return folders;
}

/// The modification time is that of the last use.
void mark_used(const fs::path& file) { ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0); }

}  // namespace

std::string entry_to_bytes(const CacheEntry& entry) {
  Json sizes = Json::array();
  for (const std::string& blob : entry.blobs) sizes.push_back(blob.size());
  // Two lines of text, then the blobs: `head -2` shows what an entry is.
  std::string body =
      Json({{"facts", parse_json(entry.facts, "facts", {entry.facts.size()})}, {"blobs", sizes}})
          .dump() +
      "\n";
  for (const std::string& blob : entry.blobs) body += blob;
  return fmt::format("{}{}\n{}", kMagic, content_hash(body), body);
}

std::optional<CacheEntry> entry_from_bytes(std::string_view bytes) {
  if (bytes.size() <= kHeader || !bytes.starts_with(kMagic) || bytes[kHeader - 1] != '\n')
    return {};
  const std::string_view body = bytes.substr(kHeader);
  if (bytes.substr(kMagic.size(), kDigits) != content_hash(body)) return {};
  const std::size_t end = body.find('\n');
  if (end == std::string_view::npos) return {};
  try {
    const Json json = parse_json(body.substr(0, end), "entry", {end});
    CacheEntry entry{json.at("facts").dump(), {}};
    std::string_view rest = body.substr(end + 1);
    for (const Json& size : json.at("blobs")) {
      const auto count = size.get<std::size_t>();
      if (count > rest.size()) return {};
      entry.blobs.emplace_back(rest.substr(0, count));
      rest.remove_prefix(count);
    }
    if (!rest.empty()) return {};
    return entry;
  } catch (const Json::exception&) {
    return {};
  } catch (const BakeError&) {
    return {};
  }
}

fs::path StageCache::file_of(const std::string& key) const {
  return options_.folder / key.substr(0, 1) / (key.substr(1) + kEnding);
}

bool StageCache::contains(const std::string& key) const {
  std::error_code error;
  return is_on() && fs::is_regular_file(file_of(key), error);
}

std::optional<CacheEntry> StageCache::find(const std::string& key, const Observer& observer) const {
  if (!contains(key)) return {};
  const fs::path file = file_of(key);
  std::optional<CacheEntry> entry;
  try {
    entry = entry_from_bytes(read_file(file, kMostBytes));
  } catch (const BakeError&) {
    if (!contains(key)) return {};  // it went meanwhile
  }
  if (entry) {
    mark_used(file);
    return entry;
  }
  std::error_code ignored;
  fs::remove(file, ignored);
  report(observer, Problem{Severity::Warning,
                           "cache.damaged",
                           {file.string(), "", 0, 0},
                           "this entry of the cache is damaged; what it held is made anew",
                           "if it happens again, look at the disk"});
  return {};
}

void StageCache::keep(const std::string& key, const CacheEntry& entry) const {
  if (!is_on()) return;
  const std::string bytes = entry_to_bytes(entry);
  if (bytes.size() > options_.size_limit / kFolders) return;
  const fs::path file = file_of(key);
  replace_unsynced(file, bytes);
  make_room(file.parent_path());
}

CacheContents StageCache::contents() const {
  CacheContents contents;
  for (const fs::path& folder : folders_of(options_.folder)) {
    for (const KeptFile& file : kept_files(folder)) {
      ++contents.entries;
      contents.bytes += file.bytes;
    }
  }
  return contents;
}

void StageCache::clear() const {
  std::error_code ignored;
  for (const fs::path& folder : folders_of(options_.folder)) {
    for (const KeptFile& file : kept_files(folder)) {
      if (!is_being_written(file)) fs::remove(file.path, ignored);
    }
    fs::remove(folder, ignored);  // fails, as it should, when something is in it
  }
}

void StageCache::make_room(const fs::path& folder) const {
  constexpr double kLeft = 0.8;  // of the limit, so that not every entry makes room anew
  std::vector<KeptFile> files = kept_files(folder);
  const auto now = fs::file_time_type::clock::now();
  std::error_code ignored;
  std::erase_if(files, [&](const KeptFile& file) {
    if (!is_being_written(file)) return false;
    if (now - file.used > kAbandoned) fs::remove(file.path, ignored);
    return true;  // else its writer still needs it
  });
  std::uintmax_t total = 0;
  for (const KeptFile& file : files) total += file.bytes;
  const std::uintmax_t limit = options_.size_limit / kFolders;
  if (total <= limit) return;
  const auto wanted = static_cast<std::uintmax_t>(static_cast<double>(limit) * kLeft);
  files.pop_back();  // what was just written stays
  for (const KeptFile& file : files) {
    if (total <= wanted) return;
    if (fs::remove(file.path, ignored)) total -= file.bytes;
  }
}

}  // namespace morphbake
