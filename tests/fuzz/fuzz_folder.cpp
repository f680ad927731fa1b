#include "fuzz/fuzz_folder.h"

#include <unistd.h>

#include <fstream>
#include <string>

namespace morphbake::fuzz {
namespace fs = std::filesystem;

FuzzFolder::FuzzFolder()
    : path(fs::temp_directory_path() / ("morphbake-fuzz-" + std::to_string(::getpid()))) {
  fs::create_directories(path);
}

FuzzFolder::~FuzzFolder() {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

fs::path FuzzFolder::write(const fs::path& name, std::string_view bytes) const {
  std::ofstream(path / name, std::ios::binary) << bytes;
  return path / name;
}

}  // namespace morphbake::fuzz
