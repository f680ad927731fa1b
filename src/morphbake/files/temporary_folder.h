#pragma once

#include <filesystem>
#include <string>

namespace morphbake {

/// A new folder that is there as long as this object, with all that is in it.
class TemporaryFolder {
 public:
  /// @param name  of which the folder's name begins
  /// @throws BakeError "output.unwritable"
  explicit TemporaryFolder(const std::string& name);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace morphbake
