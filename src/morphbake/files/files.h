#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace morphbake {

/// Reads a whole regular file.
///
/// @throws BakeError "files.missing", "files.not-a-file", "files.unreadable", "files.too-large"
std::string read_file(const std::filesystem::path& path, std::uintmax_t size_limit);

/// The first `most` bytes of a regular file, or all of a shorter one.
///
/// @throws BakeError "files.missing", "files.not-a-file", "files.unreadable"
std::string read_file_start(const std::filesystem::path& path, std::uintmax_t most);

/// The file that a relative reference `uri` inside `folder` names.
///
/// @param uri  a relative path as it stands in a glTF or recipe, percent-encoding already removed
/// @return     nothing (empty path) when it is absolute, has a scheme, or leaves the folder, also
/// by symbolic link
std::filesystem::path inside_folder(const std::filesystem::path& folder, std::string_view uri);

/// Writes a file in the stead of one that may be there. Readers see the old or the new one; but the
/// disk is not waited for, so after a loss of power it may hold anything: for what a hash guards.
///
/// @throws BakeError "output.unwritable"
void replace_unsynced(const std::filesystem::path& path, std::string_view bytes);

/// Removes what PendingOutputs of processes that were killed have left in a folder. Nobody may be
/// writing there.
void remove_temporaries(const std::filesystem::path& folder);

/// Outputs that appear together or not at all.
///
/// Each staged file is written under a random temporary name beside its final one; commit() renames
/// them. What was not committed is removed by the destructor, so errors and Ctrl-C leave nothing.
class PendingOutputs {
 public:
  PendingOutputs() = default;
  PendingOutputs(const PendingOutputs&) = delete;
  PendingOutputs& operator=(const PendingOutputs&) = delete;
  ~PendingOutputs();

  /// Writes `bytes` beside `path` and syncs them to disk. Missing folders are made.
  /// @throws BakeError "output.unwritable"
  /// @return  the temporary file, to be read back until commit()
  std::filesystem::path stage(const std::filesystem::path& path, std::string_view bytes);

  /// A fresh temporary name beside `path` for a library that writes the file itself; it must keep
  /// the extension, which such libraries choose the format by.
  std::filesystem::path stage_external(const std::filesystem::path& path);

  /// Renames everything into place.
  /// @throws BakeError "output.unwritable"
  void commit();

 private:
  struct Entry {
    std::filesystem::path temporary;
    std::filesystem::path target;
  };

  std::vector<Entry> entries_;
  std::vector<std::filesystem::path> made_folders_;
};

}  // namespace morphbake
