#include "morphbake/files/files.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>
#include <system_error>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& code, const fs::path& path, const std::string& message,
                       const std::string& hint = {}) {
  throw BakeError(Problem{Severity::Error, code, {path.string(), "", 0, 0}, message, hint});
}

[[noreturn]] void fail_to_write(const fs::path& path, int error) {
  fail("output.unwritable", path, fmt::format("cannot write: {}", std::strerror(error)),
       "check that the folder is writable and has free space, or choose another folder");
}

constexpr std::size_t kTokenLetters = 16;

/// "dir/name.gif" -> "dir/.name.3f2a9c01.tmp.gif"; the extension stays last because libraries
/// choose by it.
fs::path temporary_beside(const fs::path& path) {
  std::random_device random;
  const std::string token = fmt::format("{:08x}{:08x}", random(), random());
  // File names may have 255 bytes at most: a long name is cut, the token keeps it unique.
  const std::string stem = path.stem().string().substr(0, 180);
  return path.parent_path() / fmt::format(".{}.{}.tmp{}", stem, token, path.extension().string());
}

/// Whether temporary_beside() calls a file so.
bool is_temporary_name(const std::string& name) {
  const std::size_t end = name.rfind(".tmp");
  if (!name.starts_with('.') || end == std::string::npos || end < kTokenLetters + 2) return false;
  const std::string extension = name.substr(end + 4);
  if (!extension.empty() && extension.front() != '.') return false;
  const std::string token = name.substr(end - kTokenLetters, kTokenLetters);
  return name[end - kTokenLetters - 1] == '.' &&
         token.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// @param shown  what messages call the file
void sync_to_disk(const fs::path& path, const fs::path& shown) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail_to_write(shown, errno);
  const int result = ::fsync(descriptor);
  const int error = errno;
  ::close(descriptor);
  if (result != 0) fail_to_write(shown, error);
}

/// Whether a file's bytes are on the disk before it gets its name.
enum class Sync { Yes, No };

/// @param shown  what messages call the file
void write_new_file(const fs::path& path, std::string_view bytes, const fs::path& shown,
                    Sync sync) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) fail_to_write(shown, errno);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int error = errno;
      ::close(descriptor);
      fail_to_write(shown, error);
    }
    done += static_cast<std::size_t>(count);
  }
  const bool synced = sync == Sync::No || ::fsync(descriptor) == 0;
  const int error = errno;
  if (::close(descriptor) != 0 || !synced) fail_to_write(shown, error);
}

/// What is at a place that is to be written; nothing may be.
fs::file_status status_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const bool is_known = !error || status.type() == fs::file_type::not_found;
  if (!is_known) fail_to_write(path, error.value());  // links that lead round in circles
  return status;
}

/// Makes the folder of `path` and records what it had to make, innermost last.
void make_folders(const fs::path& folder, std::vector<fs::path>& made) {
  if (folder.empty() || status_of(folder).type() == fs::file_type::directory) return;
  make_folders(folder.parent_path(), made);
  std::error_code error;
  if (fs::create_directory(folder, error)) made.push_back(folder);
  if (error) fail_to_write(folder, error.value());
}

std::uintmax_t size_of_regular(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) fail("files.missing", path, "there is no such file");
  if (!fs::is_regular_file(status)) fail("files.not-a-file", path, "this is not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail("files.unreadable", path, "cannot read: " + error.message());
  return size;
}

/// @param size  bytes that the file has, or fewer
std::string read_bytes(const fs::path& path, std::uintmax_t size) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!stream || !stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    fail("files.unreadable", path, "cannot read the file");
  }
  return bytes;
}

}  // namespace

std::string read_file(const fs::path& path, std::uintmax_t size_limit) {
  const std::uintmax_t size = size_of_regular(path);
  if (size > size_limit) {
    fail("files.too-large", path,
         fmt::format("the file has {} bytes; the limit is {}", size, size_limit));
  }
  return read_bytes(path, size);
}

std::string read_file_start(const fs::path& path, std::uintmax_t most) {
  return read_bytes(path, std::min(size_of_regular(path), most));
}

fs::path inside_folder(const fs::path& folder, std::string_view uri) {
  const fs::path relative(uri);
  const bool has_scheme = uri.find(':') != std::string_view::npos;
  const bool has_nul = uri.find('\0') != std::string_view::npos;
  if (uri.empty() || has_scheme || has_nul || relative.is_absolute()) return {};
  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder, error);
  if (error) return {};
  const fs::path target = fs::weakly_canonical(root / relative, error);
  if (error) return {};
  const auto [root_end, ignored] =
      std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  return root_end == root.end() ? target : fs::path();
}

void replace_unsynced(const fs::path& path, std::string_view bytes) {
  std::vector<fs::path> made;
  make_folders(path.parent_path(), made);
  const fs::path temporary = temporary_beside(path);
  try {
    write_new_file(temporary, bytes, path, Sync::No);
    if (std::rename(temporary.c_str(), path.c_str()) != 0) fail_to_write(path, errno);
  } catch (const BakeError&) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

void remove_temporaries(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  while (!error && entry != fs::directory_iterator()) {
    std::error_code ignored;
    const bool is_file = entry->symlink_status(ignored).type() == fs::file_type::regular;
    if (is_file && is_temporary_name(entry->path().filename())) fs::remove(entry->path(), ignored);
    entry.increment(error);
  }
}

PendingOutputs::~PendingOutputs() {
  std::error_code ignored;
  for (const Entry& entry : entries_) fs::remove(entry.temporary, ignored);
  for (auto folder = made_folders_.rbegin(); folder != made_folders_.rend(); ++folder) {
    fs::remove(*folder, ignored);  // fails, as it should, when something is in it
  }
}

fs::path PendingOutputs::stage_external(const fs::path& path) {
  make_folders(path.parent_path(), made_folders_);
  const fs::file_status status = status_of(path);
  if (fs::is_directory(status)) fail_to_write(path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail("output.unwritable", path, "this is a device or pipe, which no file may replace",
         "choose the name of a file");
  }
  // A link stays a link: what it names is replaced.
  std::error_code error;
  const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path) : path;
  entries_.push_back({temporary_beside(target), target});
  return entries_.back().temporary;
}

fs::path PendingOutputs::stage(const fs::path& path, std::string_view bytes) {
  fs::path temporary = stage_external(path);
  write_new_file(temporary, bytes, path, Sync::Yes);
  return temporary;
}

void PendingOutputs::commit() {
  for (const Entry& entry : entries_) sync_to_disk(entry.temporary, entry.target);
  for (const Entry& entry : entries_) {
    if (std::rename(entry.temporary.c_str(), entry.target.c_str()) != 0)
      fail_to_write(entry.target, errno);
  }
  entries_.clear();
  made_folders_.clear();
}

}  // namespace morphbake
