#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/files/temporary_folder.h"

namespace morphbake::test {

/// A folder of its own with files.
class BatchFolder {
 public:
  std::filesystem::path write(const std::filesystem::path& name, const std::string& text) const {
    const std::filesystem::path file = path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  std::filesystem::path path() const { return std::filesystem::canonical(folder_.path()); }

 private:
  TemporaryFolder folder_{"morphbake-batch-test"};
};

/// All problems of `work` as they are printed, or "".
template <typename Work>
std::string problems_of(const Work& work) {
  try {
    work();
  } catch (const BakeError& error) {
    return error.what();
  }
  return "";
}

}  // namespace morphbake::test
