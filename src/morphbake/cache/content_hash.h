#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace morphbake {

/// XXH128 of bytes, as 32 hexadecimal digits.
std::string content_hash(std::string_view bytes);

/// XXH128 of a regular file's bytes, read piece by piece.
///
/// @throws BakeError "files.missing", "files.not-a-file", "files.unreadable"
std::string file_hash(const std::filesystem::path& file);

/// Hashes of files, each of which is read once: between two bakes nothing is remembered.
class FileHashes {
 public:
  /// @throws BakeError as file_hash
  const std::string& of(const std::filesystem::path& file);

 private:
  std::map<std::filesystem::path, std::string> hashes_;
};

/// A hash of this program's code and constants as they lie in memory: another build, another hash.
///
/// @return  32 hexadecimal digits; the same for every process of one build
const std::string& program_hash();

}  // namespace morphbake
