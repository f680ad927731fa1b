#include "morphbake/batch/table.h"

#include <fmt/core.h>

#include <fstream>
#include <memory>
#include <set>
#include <utility>

#include "morphbake/batch/csv.h"
#include "morphbake/batch/entry_names.h"
#include "morphbake/batch/line_reader.h"
#include "morphbake/files/files.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// Where a row begins, and in which line.
struct RowPlace {
  std::uint64_t offset;
  int line;
};

/// A cell as JSON text.
std::string value_of(const std::string& cell, const std::string& table) {
  try {
    return parse_json(cell, table).dump();
  } catch (const BakeError&) {
    return Json(cell).dump(-1, ' ', false, Json::error_handler_t::strict);
  }
}

bool is_utf8(const std::string& text) {
  try {
    Json(text).dump();
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

/// What is wrong with a row, or "".
std::string fault_of(const CsvRow& row, std::size_t columns) {
  if (row.is_too_long) return fmt::format("the row has more than {} bytes", LineReader::kLongest);
  if (row.is_unclosed) return "a quote is never closed";
  if (row.is_misquoted) return "something stands behind a closing quote";
  if (columns > 0 && row.cells.size() != columns) {
    return fmt::format("the row has {} cells, the first line {}", row.cells.size(), columns);
  }
  for (const std::string& cell : row.cells) {
    if (!is_utf8(cell)) return "a cell is no UTF-8";
  }
  return "";
}

Problem bad_table(const Location& at, std::string message) {
  return {Severity::Error, "batch.bad-table", at, std::move(message),
          "the first line names columns: name, and JSON pointers as /timeline/duration; quotes "
          "inside of quotes are doubled"};
}

void drop_byte_order_mark(std::string& text) {
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
}

/// The first row: a JSON pointer or "name" a column.
std::vector<std::string> columns_of(CsvRow row, const fs::path& table) {
  drop_byte_order_mark(row.cells.front());
  const std::string fault = fault_of(row, 0);
  if (!fault.empty()) throw BakeError(bad_table({table.string(), "", row.line, 0}, fault));
  std::set<std::string> seen;
  std::vector<Problem> problems;
  for (std::size_t c = 0; c < row.cells.size(); ++c) {
    const Location at{table.string(), "", row.line, static_cast<int>(c) + 1};
    const std::string& column = row.cells[c];
    if (column != "name" && !column.starts_with('/')) {
      problems.push_back(bad_table(
          at, fmt::format("{} is neither \"name\" nor a JSON pointer", shown(Json(column)))));
    } else if (!seen.insert(column).second) {
      problems.push_back(
          bad_table(at, fmt::format("there are two columns {}", shown(Json(column)))));
    }
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return std::move(row.cells);
}

std::string name_in(const CsvRow& row, const std::vector<std::string>& columns) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c] == "name") return row.cells[c];
  }
  return "";
}

bool is_blank(const CsvRow& row) { return row.cells.size() == 1 && row.cells.front().empty(); }

BatchEntry as_entry(const CsvRow& row, const std::vector<std::string>& columns,
                    const fs::path& recipe, const std::string& table) {
  BatchEntry entry{"", recipe, {}, {table, "", row.line, 0}};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c] == "name" || row.cells[c].empty()) continue;
    const Location at{table, "", row.line, static_cast<int>(c) + 1};
    entry.changes.push_back({columns[c], value_of(row.cells[c], table), at});
  }
  return entry;
}

}  // namespace

std::string row_name(const fs::path& recipe, std::size_t row) {
  return fmt::format("{}-{}", recipe.stem().string(), row);
}

Manifest read_csv_table(const fs::path& recipe, const fs::path& table) {
  read_file_start(table, 1);  // says what is wrong with it
  auto stream = std::make_shared<std::ifstream>(table, std::ios::binary);
  CsvReader reader(*stream);
  CsvRow row;
  if (!reader.next(row)) throw BakeError(bad_table({table.string(), "", 0, 0}, "this is empty"));
  const std::vector<std::string> columns = columns_of(row, table);
  EntryNames names;
  std::vector<RowPlace> places;
  const auto here = [&] {
    return static_cast<std::uint64_t>(stream->rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in));
  };
  for (std::uint64_t offset = here(); reader.next(row); offset = here()) {
    if (is_blank(row)) continue;
    const Location at{table.string(), "", row.line, 0};
    const std::string fault = fault_of(row, columns.size());
    if (!fault.empty()) {
      names.complain(bad_table(at, fault));
      continue;
    }
    std::string name = name_in(row, columns);
    if (name.empty()) name = row_name(recipe, places.size() + 1);
    if (names.take(name, at, "give the row another name")) places.push_back({offset, row.line});
  }
  Manifest manifest;
  manifest.names =
      names.finish({table.string(), "", 0, 0}, "write a row of values below that of JSON pointers");
  manifest.read = [=, places = std::move(places)](std::size_t i) {
    stream->clear();
    stream->seekg(static_cast<std::streamoff>(places[i].offset));
    CsvRow again;
    CsvReader(*stream, places[i].line).next(again);
    again.cells.resize(columns.size());
    return as_entry(again, columns, recipe, table.string());
  };
  return manifest;
}

}  // namespace morphbake
