#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace morphbake {

/// @throws BakeError "output.unwritable" for an errno
[[noreturn]] void fail_to_write(const std::filesystem::path& file, int error);

/// Writes a file by what `write` puts into it; it appears when it is whole.
///
/// @throws BakeError "output.unwritable"
void write_whole(const std::filesystem::path& file,
                 const std::function<void(std::ostream&)>& write);

/// Which part of a list a run bakes: `index` of `count`, from 1.
struct Shard {
  int index = 1;
  int count = 1;
};

/// DIR/report.jsonl, or DIR/report.I-of-N.jsonl of a shard.
std::filesystem::path report_file(const std::filesystem::path& folder, const Shard& shard);

/// DIR/failures.jsonl, or DIR/failures.I-of-N.jsonl of a shard.
std::filesystem::path failures_file(const std::filesystem::path& folder, const Shard& shard);

/// All reports in a folder, of whole runs and shards, in the order of their names.
std::vector<std::filesystem::path> report_files(const std::filesystem::path& folder);

/// Makes a report without lines if it is missing.
///
/// @throws BakeError "output.unwritable" when nothing can be appended to it
void make_report(const std::filesystem::path& report);

/// Appends a line to a report that other processes may append to, and replace, at the same time. A
/// line that was cut off before is ended.
///
/// @throws BakeError "output.unwritable"; then nothing was appended
void append_line(const std::filesystem::path& report, const std::string& line);

/// A line of a report.
struct ReportLine {
  std::size_t report = 0;  ///< of those that were named
  std::string text;
};

/// Where the last line of each name is in some reports. The files stay open: what replaces them
/// meanwhile is not seen.
class ReportIndex {
 public:
  explicit ReportIndex(const std::vector<std::filesystem::path>& reports);

  /// The lines of a name, one a report that has it, from the last report that was named to the
  /// first.
  std::vector<ReportLine> lines_of(const std::string& name) const;

  /// All names, sorted.
  std::vector<std::string> names() const;

  /// How many lines are no records: cut off, or of another program.
  int broken_lines() const { return broken_lines_; }

 private:
  struct Place {
    std::uint32_t report;
    std::uint64_t offset;
  };

  void note(const std::string& name, Place place);

  mutable std::vector<std::ifstream> streams_;
  std::unordered_multimap<std::string, Place> places_;
  int broken_lines_ = 0;
};

/// Replaces a report at once by what `write` writes, while no other process appends to it.
///
/// @throws BakeError "output.unwritable"; then the report is as it was
void replace_report(const std::filesystem::path& report,
                    const std::function<void(std::ostream&)>& write);

}  // namespace morphbake
