#include "morphbake/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

namespace morphbake {

FileLock::FileLock(const std::filesystem::path& file, Kind kind, bool wait) {
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(file, error);
  const int how = is_folder ? O_RDONLY | O_DIRECTORY : O_RDWR | O_APPEND | O_CREAT;
  descriptor_ = ::open(file.c_str(), how | O_CLOEXEC, 0666);
  if (descriptor_ < 0) return;
  const int operation = (kind == Kind::Alone ? LOCK_EX : LOCK_SH) | (wait ? 0 : LOCK_NB);
  int result = ::flock(descriptor_, operation);
  while (result != 0 && errno == EINTR) result = ::flock(descriptor_, operation);
  is_held_ = result == 0;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace morphbake
