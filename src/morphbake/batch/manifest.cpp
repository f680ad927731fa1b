#include "morphbake/batch/manifest.h"

#include <fmt/core.h>

#include <fstream>
#include <memory>
#include <utility>

#include "morphbake/batch/entry_names.h"
#include "morphbake/batch/glob.h"
#include "morphbake/batch/line_reader.h"
#include "morphbake/batch/manifest_line.h"
#include "morphbake/batch/table.h"
#include "morphbake/files/files.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kListHint = "a line of a list is a recipe's file name in quotes";
constexpr const char* kTableHint =
    R"(a line of a table is an object such as {"/timeline/duration": 2})";
constexpr const char* kNameHint = R"(give the recipe a "name", such as "faces/nose")";

/// How a recipe is called that is named as `file` from the manifest's folder on.
std::string default_name(const fs::path& file) {
  return fs::path(file).replace_extension().lexically_normal().string();
}

bool is_blank(const std::string& line) {
  return line.find_first_not_of(" \t") == std::string::npos;
}

/// Where a line of a list begins, and its number.
struct LinePlace {
  std::uint64_t offset;
  int number;
};

BatchEntry as_entry(const ManifestLine& line, const fs::path& recipe, const Location& at) {
  BatchEntry entry{"", recipe, {}, at};
  for (const auto& [pointer, value] : line.set) entry.changes.push_back({pointer, value, at});
  return entry;
}

/// Lines of a list, or of a table of the one recipe that is given.
Manifest read_lines(const fs::path& list, const fs::path& recipe) {
  const bool is_table = !recipe.empty();
  const auto read = [is_table](const std::string& text, const Location& at) {
    return is_table ? read_table_line(text, at) : read_manifest_line(text, at);
  };
  EntryNames names;
  std::vector<LinePlace> places;
  for (LineReader reader(list); reader.next();) {
    const Location at{list.string(), "", reader.number(), 0};
    if (reader.is_too_long()) {
      names.complain({Severity::Error, "batch.line-too-long", at,
                      fmt::format("the line has more than {} bytes", LineReader::kLongest),
                      "a line is one recipe"});
      continue;
    }
    if (is_blank(reader.line())) continue;
    try {
      const ManifestLine line = read(reader.line(), at);
      std::string name = line.name;
      if (name.empty() && is_table) name = row_name(recipe, places.size() + 1);
      if (name.empty()) name = default_name(line.recipe);
      if (names.take(name, at, kNameHint)) places.push_back({reader.offset(), reader.number()});
    } catch (const BakeError& error) {
      names.complain(error);
    }
  }
  Manifest manifest;
  manifest.names = names.finish({list.string(), "", 0, 0}, is_table ? kTableHint : kListHint);
  // The file stays open, so that another that takes its name meanwhile is not read.
  auto stream = std::make_shared<std::ifstream>(list, std::ios::binary);
  manifest.read = [=, places = std::move(places)](std::size_t i) {
    const Location at{list.string(), "", places[i].number, 0};
    const ManifestLine line = read(line_at(*stream, places[i].offset), at);
    return as_entry(line, is_table ? recipe : list.parent_path() / line.recipe, at);
  };
  return manifest;
}

Manifest read_pattern(const std::string& pattern) {
  std::vector<fs::path> files = files_matching(pattern);
  const fs::path folder = folder_before_wildcards(pattern);
  EntryNames names;
  for (const fs::path& file : files) {
    const fs::path below = folder.empty() ? file : file.lexically_relative(folder);
    names.take(default_name(below), {file.string(), "", 0, 0}, "name other files");
  }
  Manifest manifest;
  manifest.names = names.finish({pattern, "", 0, 0}, "no file matches: see what `ls` finds");
  manifest.read = [files = std::move(files)](std::size_t i) {
    return BatchEntry{"", files[i], {}, {files[i].string(), "", 0, 0}};
  };
  return manifest;
}

Manifest read_table(const fs::path& recipe, const fs::path& table) {
  return table.extension() == ".csv" ? read_csv_table(recipe, table) : read_lines(table, recipe);
}

[[noreturn]] void refuse(const fs::path& file, const std::string& message,
                         const std::string& hint) {
  throw BakeError(
      Problem{Severity::Error, "batch.bad-manifest", {file.string(), "", 0, 0}, message, hint});
}

}  // namespace

BatchEntry entry_of(const Manifest& manifest, std::size_t index) {
  BatchEntry entry = manifest.read(index);
  entry.name = manifest.names[index];
  return entry;
}

Manifest read_manifest(const fs::path& named, const fs::path& table) {
  std::error_code error;
  const bool is_there = fs::exists(named, error);
  if (!is_there && is_pattern(named)) {
    if (!table.empty()) refuse(named, "a table is of one recipe", "name one recipe (.json)");
    return read_pattern(named);
  }
  if (fs::is_directory(named, error)) {
    refuse(named, "this is a folder",
           fmt::format("write '{}/**/*.json' in quotes", named.string()));
  }
  read_file_start(named, 1);  // says what is wrong with it
  if (named.extension() == ".json") {
    if (!table.empty()) return read_table(named, table);
    EntryNames names;
    const Location at{named.string(), "", 0, 0};
    names.take(default_name(named.filename()), at, "call the file otherwise");
    return {names.finish(at, kNameHint), [=](std::size_t) {
              return BatchEntry{"", named, {}, at};
            }};
  }
  if (!table.empty()) refuse(named, "a table is of one recipe", "name one recipe (.json)");
  if (named.extension() != ".jsonl") {
    refuse(named, "this is neither a list (.jsonl) nor a recipe (.json)", kListHint);
  }
  return read_lines(named, {});
}

}  // namespace morphbake
