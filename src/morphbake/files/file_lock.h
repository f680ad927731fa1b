#pragma once

#include <filesystem>

namespace morphbake {

/// A lock (flock) on a file, which is made, or on a folder that is there; it ends with this object
/// or its process. Processes that do not ask are not held back. Where the file system knows no
/// locks, none is held.
class FileLock {
 public:
  enum class Kind { Shared, Alone };

  /// @param wait  false: nothing is held when others hold it
  FileLock(const std::filesystem::path& file, Kind kind, bool wait);
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

  bool is_held() const { return is_held_; }

  /// Open for reading and appending, of a folder for neither; -1 when it could not be opened, with
  /// errno as that left it.
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
  bool is_held_ = false;
};

}  // namespace morphbake
