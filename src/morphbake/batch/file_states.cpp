#include "morphbake/batch/file_states.h"

#include <sys/stat.h>

#include <chrono>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSecond = 1000000000;
constexpr std::int64_t kRacy = 2 * kSecond;  // FAT and some network shares keep times in 2 s

/// Size and time of a regular file; false where there is none.
bool look_at(const fs::path& file, FileState& state) {
  struct stat status = {};
  if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  state.bytes = static_cast<std::uint64_t>(status.st_size);
  state.mtime = status.st_mtim.tv_sec * kSecond + status.st_mtim.tv_nsec;
  return true;
}

bool has_hash(const fs::path& file, const std::string& hash, FileHashes& hashes) {
  try {
    return hashes.of(file) == hash;
  } catch (const BakeError&) {
    return false;  // it cannot be read
  }
}

}  // namespace

std::int64_t time_now() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count();
}

FileState state_of(const fs::path& file, const fs::path& folder, FileHashes& hashes) {
  FileState state;
  state.file = fs::proximate(file, folder).string();
  state.is_there = look_at(file, state);
  if (state.is_there) state.hash = hashes.of(file);
  return state;
}

Unchanged are_unchanged(const std::vector<FileState>& states, const fs::path& folder,
                        std::int64_t written, FileHashes& hashes) {
  Unchanged unchanged;
  for (const FileState& state : states) {
    FileState now;
    const fs::path file = (folder / state.file).lexically_normal();
    now.is_there = look_at(file, now);
    if (now.is_there != state.is_there || now.bytes != state.bytes) return {false, false};
    if (!now.is_there) continue;
    const bool may_be_racy = now.mtime != state.mtime || now.mtime >= written - kRacy;
    if (!may_be_racy) continue;
    unchanged.by_hash = true;
    if (!has_hash(file, state.hash, hashes)) return {false, true};
  }
  return unchanged;
}

void note_times(std::vector<FileState>& states, const fs::path& folder) {
  for (FileState& state : states) look_at(folder / state.file, state);
}

}  // namespace morphbake
