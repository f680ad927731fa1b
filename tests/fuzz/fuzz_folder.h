#pragma once

#include <filesystem>
#include <string_view>

namespace morphbake::fuzz {

/// A folder of its own below the system's temporary one, removed at the end.
class FuzzFolder {
 public:
  FuzzFolder();
  FuzzFolder(const FuzzFolder&) = delete;
  FuzzFolder& operator=(const FuzzFolder&) = delete;
  ~FuzzFolder();

  /// Writes `bytes` over the file `name` of this folder and returns its path.
  std::filesystem::path write(const std::filesystem::path& name, std::string_view bytes) const;

  std::filesystem::path path;
};

}  // namespace morphbake::fuzz
