#include "morphbake/batch/report_file.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "morphbake/batch/batch_record.h"
#include "morphbake/batch/line_reader.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/files/file_lock.h"
#include "morphbake/files/files.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

fs::path named(const fs::path& folder, const char* what, const Shard& shard) {
  if (shard.count == 1) return folder / fmt::format("{}.jsonl", what);
  return folder / fmt::format("{}.{}-of-{}.jsonl", what, shard.index, shard.count);
}

/// Whether `descriptor` is still the file that has this name.
bool is_still(const fs::path& file, int descriptor) {
  struct stat opened = {};
  struct stat there = {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &there) == 0 &&
         opened.st_ino == there.st_ino && opened.st_dev == there.st_dev;
}

/// Locks a report that is made if it is missing, and calls `work` with its descriptor.
void with_locked(const fs::path& report, const std::function<void(int)>& work) {
  std::error_code error;
  if (fs::is_directory(report, error)) fail_to_write(report, EISDIR);
  while (true) {
    const FileLock lock(report, FileLock::Kind::Alone, true);
    if (lock.descriptor() < 0) fail_to_write(report, errno);
    if (is_still(report, lock.descriptor())) return work(lock.descriptor());
  }
}

/// Whether the bytes end within a line.
bool ends_torn(int descriptor, off_t size) {
  char last = '\n';
  return size > 0 && ::pread(descriptor, &last, 1, size - 1) == 1 && last != '\n';
}

}  // namespace

void fail_to_write(const fs::path& file, int error) {
  throw BakeError(Problem{Severity::Error,
                          "output.unwritable",
                          {file.string(), "", 0, 0},
                          fmt::format("cannot write: {}", std::strerror(error)),
                          "check that the folder is writable and has free space"});
}

void write_whole(const fs::path& file, const std::function<void(std::ostream&)>& write) {
  PendingOutputs outputs;
  std::ofstream stream(outputs.stage_external(file), std::ios::binary);
  write(stream);
  stream.close();
  if (!stream) fail_to_write(file, ENOSPC);
  outputs.commit();
}

fs::path report_file(const fs::path& folder, const Shard& shard) {
  return named(folder, "report", shard);
}

fs::path failures_file(const fs::path& folder, const Shard& shard) {
  return named(folder, "failures", shard);
}

std::vector<fs::path> report_files(const fs::path& folder) {
  std::vector<fs::path> reports;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  while (!error && entry != fs::directory_iterator()) {
    const std::string name = entry->path().filename();
    const bool is_named_so = name.starts_with("report.") && name.ends_with(".jsonl");
    if (is_named_so && entry->is_regular_file(error)) reports.push_back(entry->path());
    entry.increment(error);
  }
  std::ranges::sort(reports);
  return reports;
}

void make_report(const fs::path& report) {
  with_locked(report, [](int) {});
}

void append_line(const fs::path& report, const std::string& line) {
  with_locked(report, [&](int descriptor) {
    const off_t size = ::lseek(descriptor, 0, SEEK_END);
    const std::string text = (ends_torn(descriptor, size) ? "\n" : "") + line + "\n";
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count == static_cast<ssize_t>(text.size())) return;
    const int error = count < 0 ? errno : ENOSPC;
    if (::ftruncate(descriptor, size) != 0) fail_to_write(report, errno);
    fail_to_write(report, error);
  });
}

void replace_report(const fs::path& report, const std::function<void(std::ostream&)>& write) {
  with_locked(report, [&](int) { write_whole(report, write); });
}

ReportIndex::ReportIndex(const std::vector<fs::path>& reports) {
  for (const fs::path& report : reports) {
    const auto number = static_cast<std::uint32_t>(streams_.size());
    streams_.emplace_back(report, std::ios::binary);
    std::error_code error;
    if (fs::file_size(report, error) == 0 || error) continue;
    for (LineReader reader(report); reader.next();) {
      if (reader.line().empty() && !reader.is_too_long()) continue;
      const std::string name = start_of_line(reader.line()).name;
      if (name.empty() || !reader.is_ended()) {
        ++broken_lines_;
        continue;
      }
      note(name, {number, reader.offset()});
    }
  }
}

void ReportIndex::note(const std::string& name, Place place) {
  const auto [first, last] = places_.equal_range(name);
  const auto same = std::find_if(
      first, last, [&](const auto& each) { return each.second.report == place.report; });
  if (same != last) {
    same->second = place;
  } else {
    places_.emplace(name, place);
  }
}

std::vector<ReportLine> ReportIndex::lines_of(const std::string& name) const {
  std::vector<Place> places;
  const auto [first, last] = places_.equal_range(name);
  for (auto each = first; each != last; ++each) places.push_back(each->second);
  std::ranges::sort(places, std::greater(), &Place::report);
  std::vector<ReportLine> lines;
  for (const Place& place : places) {
    lines.push_back({place.report, line_at(streams_[place.report], place.offset)});
  }
  return lines;
}

std::vector<std::string> ReportIndex::names() const {
  std::vector<std::string> names;
  names.reserve(places_.size());
  for (const auto& [name, place] : places_) names.push_back(name);
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace morphbake
