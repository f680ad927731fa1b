#include "morphbake/batch/batch_results.h"

#include <algorithm>
#include <cerrno>
#include <optional>

#include "morphbake/batch/batch_page.h"
#include "morphbake/batch/line_reader.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

void for_each_line(const fs::path& report, const std::function<void(const std::string&)>& take) {
  for (LineReader reader(report); reader.next();) take(reader.line());
}

/// With files as the user calls them.
BatchResult shown_in(const fs::path& folder, BatchResult result) {
  for (fs::path* file : {&result.report, &result.failures, &result.page}) {
    if (!file->empty()) *file = folder / file->filename();
  }
  return result;
}

/// Whether the outputs that a line tells of are there.
bool has_outputs(const BatchRecord& record, const fs::path& folder) {
  std::error_code error;
  return record.is_done && std::ranges::all_of(record.outputs, [&](const FileState& output) {
           return fs::exists(folder / output.file, error);
         });
}

}  // namespace

void take_others(const ReportIndex& index, const std::unordered_set<std::string>& own,
                 const fs::path& folder, bool is_alone, const TakeLine& take) {
  for (const std::string& name : index.names()) {
    if (own.contains(name)) continue;
    for (const ReportLine& line : index.lines_of(name)) {
      const std::optional<BatchRecord> record = record_from_line(line.text);
      if (record && (!is_alone || has_outputs(*record, folder))) take(line.text);
    }
  }
}

fs::path make_batch_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path canonical = fs::canonical(folder, error);
  if (error) fail_to_write(folder, error.value());
  if (!fs::is_directory(canonical)) fail_to_write(folder, ENOTDIR);
  return canonical;
}

BatchResult write_results(const fs::path& folder, const BatchOptions& options,
                          const ReportLines& lines) {
  BatchResult result;
  result.report = report_file(folder, options.shard);
  result.failures = failures_file(folder, options.shard);
  replace_report(result.report, [&](std::ostream& report) {
    lines([&](const std::string& line) {
      report << line << '\n';
      const bool is_done = start_of_line(line).is_done;
      ++result.progress.done;
      if (!is_done) ++result.progress.failed;
    });
  });
  result.progress.total = result.progress.done;
  write_whole(result.failures, [&](std::ostream& failures) {
    for_each_line(result.report, [&](const std::string& line) {
      if (!start_of_line(line).is_done) failures << line << '\n';
    });
  });
  if (!options.write_page) return shown_in(options.folder, result);
  result.page = folder / "index.html";
  write_whole(result.page, [&](std::ostream& page) {
    write_page_start(page, result.progress);
    for_each_line(result.report, [&](const std::string& line) {
      const std::optional<BatchRecord> record = record_from_line(line);
      if (record) write_page_row(page, *record);
    });
    write_page_end(page);
  });
  return shown_in(options.folder, result);
}

}  // namespace morphbake
