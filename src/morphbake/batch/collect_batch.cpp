#include "morphbake/batch/bake_job.h"
#include "morphbake/batch/batch_results.h"
#include "morphbake/batch/file_states.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// Whether a line tells of what is there.
bool holds(const BatchRecord& record, const fs::path& folder, FileHashes& inputs) {
  FileHashes outputs;
  return record.is_done && are_unchanged(record.outputs, folder, record.written, outputs).is_true &&
         are_unchanged(record.inputs, folder, record.written, inputs).is_true;
}

/// Of several lines one that holds, else the last.
std::string best_of(const std::vector<ReportLine>& lines, const fs::path& folder,
                    FileHashes& hashes) {
  if (lines.size() == 1) return lines.front().text;
  std::string best;
  std::int64_t last = 0;
  bool best_holds = false;
  for (const ReportLine& line : lines) {
    const std::optional<BatchRecord> record = record_from_line(line.text);
    if (!record) continue;
    const bool is_good = holds(*record, folder, hashes);
    const bool is_better = is_good == best_holds ? record->written > last : is_good;
    if (!best.empty() && !is_better) continue;
    best = line.text;
    last = record->written;
    best_holds = is_good;
  }
  return best;
}

BatchRecord missing_record(const BatchEntry& entry, const fs::path& folder,
                           const BatchOptions& options) {
  BatchRecord record = begun_record(entry, folder, options);
  record.problems = {{Severity::Error,
                      "batch.missing",
                      {entry.recipe.string(), "", 0, 0},
                      "no report has a line of it: its shard was not run, or not to its end",
                      "run the shard again: it goes on where it was"}};
  return record;
}

}  // namespace

BatchResult collect_batch(const Manifest& manifest, const BatchOptions& options,
                          const BatchObserver& observer) {
  const fs::path folder = make_batch_folder(options.folder);
  FileHashes hashes;
  return write_results(folder, options, [&](const TakeLine& take) {
    const ReportIndex index(report_files(folder));
    std::unordered_set<std::string> own;
    for (std::size_t i = 0; i < manifest.names.size(); ++i) {
      std::string line = best_of(index.lines_of(manifest.names[i]), folder, hashes);
      if (line.empty()) {
        const BatchRecord record = missing_record(entry_of(manifest, i), folder, options);
        line = record_to_line(record);
        if (observer.on_failure) observer.on_failure(record);
      }
      take(line);
      own.insert(manifest.names[i]);
    }
    take_others(ReportIndex({report_file(folder, {})}), own, folder, true, take);
  });
}

}  // namespace morphbake
