#pragma once

#include <istream>
#include <string>
#include <vector>

namespace morphbake {

/// A row of a table.
struct CsvRow {
  std::vector<std::string> cells;
  int line = 0;               ///< in which it begins, from 1
  bool is_too_long = false;   ///< beyond LineReader::kLongest bytes: cells are not all there
  bool is_unclosed = false;   ///< a quote that nothing ends
  bool is_misquoted = false;  ///< something stands behind a closing quote
};

/// Reads CSV (RFC 4180: commas, quotes doubled inside of quotes, line breaks inside of quotes).
class CsvReader {
 public:
  /// @param line  the number of the line that comes next
  explicit CsvReader(std::istream& stream, int line = 1) : stream_(stream), line_(line) {}

  /// @return  false at the end
  bool next(CsvRow& row);

 private:
  std::istream& stream_;
  int line_;
};

}  // namespace morphbake
