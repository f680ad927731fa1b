#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace morphbake {

/// Reads a text file line by line, of which none is kept and none may be endless.
class LineReader {
 public:
  static constexpr std::size_t kLongest = std::size_t{16} << 20;  ///< bytes of a line

  /// @throws BakeError "files.missing", "files.not-a-file", "files.unreadable"
  explicit LineReader(const std::filesystem::path& file);

  /// Reads the next line. Of one that is too long nothing is kept.
  ///
  /// @return  false at the end of the file
  bool next();

  const std::string& line() const { return line_; }  ///< without its end

  int number() const { return number_; }  ///< of the line, from 1

  std::uint64_t offset() const { return offset_; }  ///< of its first byte

  bool is_too_long() const { return is_too_long_; }

  bool is_ended() const { return is_ended_; }  ///< whether a line break follows

 private:
  std::ifstream stream_;
  std::string line_;
  std::uint64_t offset_ = 0;
  std::uint64_t next_offset_ = 0;
  int number_ = 0;
  bool is_too_long_ = false;
  bool is_ended_ = false;
};

/// The line that begins at `offset`, of at most LineReader::kLongest bytes.
///
/// @return  "" where there is none
std::string line_at(std::istream& stream, std::uint64_t offset);

}  // namespace morphbake
