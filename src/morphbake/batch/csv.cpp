#include "morphbake/batch/csv.h"

#include "morphbake/batch/line_reader.h"

namespace morphbake {
namespace {

constexpr int kEnd = std::char_traits<char>::eof();

/// Where the reading of a row is.
enum class State { Start, Plain, Quoted, AfterQuote };

}  // namespace

bool CsvReader::next(CsvRow& row) {
  std::streambuf& buffer = *stream_.rdbuf();
  row = CsvRow{{""}, line_};
  if (buffer.sgetc() == kEnd) return false;
  State state = State::Start;
  std::size_t count = 0;
  for (int letter = buffer.sbumpc(); letter != kEnd; letter = buffer.sbumpc()) {
    if (letter == '\n') ++line_;
    if (++count > LineReader::kLongest) row.is_too_long = true;
    const bool is_quoted = state == State::Quoted;
    if (is_quoted && letter == '"') {
      state = State::AfterQuote;
    } else if (!is_quoted && letter == '\n') {
      return true;
    } else if (!is_quoted && letter == ',') {
      state = State::Start;
      if (!row.is_too_long) row.cells.emplace_back();
    } else if (!is_quoted && letter == '\r' && buffer.sgetc() == '\n') {
      continue;
    } else if (letter == '"' && state == State::Start) {
      state = State::Quoted;
    } else {
      const bool is_doubled = state == State::AfterQuote && letter == '"';
      if (state == State::AfterQuote && !is_doubled) row.is_misquoted = true;
      state = is_quoted || is_doubled ? State::Quoted : State::Plain;
      if (!row.is_too_long) row.cells.back().push_back(static_cast<char>(letter));
    }
  }
  row.is_unclosed = state == State::Quoted;
  return true;
}

}  // namespace morphbake
