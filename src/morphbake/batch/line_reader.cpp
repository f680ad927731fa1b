#include "morphbake/batch/line_reader.h"

#include "morphbake/files/files.h"

namespace morphbake {
namespace {

/// Appends what comes before the next line break, or nothing more beyond the limit.
///
/// @return  how many bytes were read; `ended` tells whether a line break was the last of them
std::uint64_t read_line(std::istream& stream, std::string& line, bool& ended) {
  std::streambuf& buffer = *stream.rdbuf();
  std::uint64_t count = 0;
  ended = false;
  for (int letter = buffer.sbumpc(); letter != std::char_traits<char>::eof();
       letter = buffer.sbumpc()) {
    ++count;
    if (letter == '\n') {
      ended = true;
      break;
    }
    if (count <= LineReader::kLongest) line.push_back(static_cast<char>(letter));
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return count;
}

}  // namespace

LineReader::LineReader(const std::filesystem::path& file) {
  read_file_start(file, 1);  // says what is wrong with it
  stream_.open(file, std::ios::binary);
}

bool LineReader::next() {
  line_.clear();
  offset_ = next_offset_;
  const std::uint64_t count = read_line(stream_, line_, is_ended_);
  if (count == 0) return false;
  next_offset_ += count;
  ++number_;
  is_too_long_ = count - (is_ended_ ? 1 : 0) > kLongest;
  if (is_too_long_) line_.clear();
  return true;
}

std::string line_at(std::istream& stream, std::uint64_t offset) {
  stream.clear();
  stream.seekg(static_cast<std::streamoff>(offset));
  std::string line;
  bool ended = false;
  if (stream) read_line(stream, line, ended);
  return line;
}

}  // namespace morphbake
