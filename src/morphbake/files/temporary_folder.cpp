#include "morphbake/files/temporary_folder.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& name) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  std::string path = (parent / (name + "-XXXXXX")).string();
  if (!error && mkdtemp(path.data()) != nullptr) {
    path_ = path;
    return;
  }
  throw BakeError(Problem{Severity::Error,
                          "output.unwritable",
                          {parent.string(), "", 0, 0},
                          fmt::format("cannot make a temporary folder: {}",
                                      error ? error.message() : std::string(std::strerror(errno))),
                          "set TMPDIR to a folder that is writable and has free space"});
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace morphbake
