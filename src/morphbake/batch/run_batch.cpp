#include "morphbake/batch/run_batch.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "morphbake/batch/bake_job.h"
#include "morphbake/batch/bake_queue.h"
#include "morphbake/batch/batch_results.h"
#include "morphbake/batch/connectivity_keys.h"
#include "morphbake/batch/file_states.h"
#include "morphbake/batch/isolated_process.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/files/file_lock.h"
#include "morphbake/files/files.h"
#include "morphbake/json/json.h"
#include "morphbake/linear/cholesky_factor.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTick(100);

/// Which shard a hash belongs to, from 1.
int shard_of(const std::string& hash, int count) {
  std::uint64_t number = 0;
  std::from_chars(hash.data(), hash.data() + 16, number, 16);
  return static_cast<int>(number % static_cast<std::uint64_t>(count)) + 1;
}

/// The entries of a list that are in a shard: those that share a connectivity are in one.
///
/// @throws Cancelled
std::vector<std::size_t> entries_in(const Shard& shard, const Manifest& manifest,
                                    ConnectivityKeys& keys, const BatchObserver& observer) {
  std::vector<std::size_t> entries;
  for (std::size_t i = 0; i < manifest.names.size(); ++i) {
    if (observer.is_cancelled && observer.is_cancelled()) throw Cancelled();
    if (shard.count > 1) {
      const std::string key = keys.of(entry_of(manifest, i));
      const std::string hash = key.empty() ? content_hash(manifest.names[i]) : key;
      if (shard_of(hash, shard.count) != shard.index) continue;
    }
    entries.push_back(i);
  }
  return entries;
}

Problem crash_of(const ProcessOutcome& outcome, const BatchOptions& options) {
  Problem problem;
  if (outcome.was_asked) {
    problem.code = "batch.timeout";
    problem.message = fmt::format("it took more than {:g} s", options.timeout);
    problem.hint = "allow more with --timeout, or ask for less: fewer frames, smaller meshes";
    return problem;
  }
  problem.code = "batch.crashed";
  const char* name = outcome.signal > 0 ? ::sigdescr_np(outcome.signal) : nullptr;
  problem.message = outcome.signal > 0
                        ? fmt::format("its process was ended by signal {} ({})", outcome.signal,
                                      name ? name : "?")
                        : fmt::format("its process ended with {} and no result", outcome.exit_code);
  problem.hint =
      outcome.signal == 9
          ? "the system may have run out of memory: run fewer at once (-j), or limit "
            "each (--memory)"
          : "bake it by itself; a crash is a bug of morphbake: please report it with the "
            "recipe and its sources";
  return problem;
}

/// A batch on its way.
class BatchRun {
 public:
  BatchRun(const Manifest& manifest, const BatchOptions& options, const BatchObserver& observer)
      : manifest_(manifest),
        options_(options),
        observer_(observer),
        folder_(make_batch_folder(options.folder)),
        report_(report_file(folder_, options.shard)),
        earlier_(read_reports()),
        chosen_(entries_in(options.shard, manifest, keys_, observer)),
        queue_(chosen_),
        processes_({options.timeout, options.memory * 1e9}) {
    progress_.total = chosen_.size();
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    most_ =
        static_cast<std::size_t>(std::max(options.processes > 0 ? options.processes : cores, 1));
  }

  BatchResult run();

 private:
  /// Whose process runs.
  struct Running {
    BakeJob job;
    std::string makes;
  };

  /// What came of looking at the next entry.
  enum class Step { Taken, Nothing, NoProcess };

  ReportIndex read_reports();
  Step take_next();
  bool is_there_already(const BatchEntry& entry, std::optional<BatchRecord>& before);
  Step start(std::size_t entry, Running next);
  void settle(const ProcessOutcome& outcome);
  void note(const JobResult& result);
  void stop();
  void tell_progress();

  bool is_cancelled() const { return observer_.is_cancelled && observer_.is_cancelled(); }

  BatchResult finish(bool is_alone) const;

  const Manifest& manifest_;
  const BatchOptions& options_;
  const BatchObserver& observer_;
  fs::path folder_;
  fs::path report_;
  std::size_t own_report_ = 0;  ///< of those that earlier_ has
  ReportIndex earlier_;
  ConnectivityKeys keys_;
  std::vector<std::size_t> chosen_;
  BakeQueue queue_;
  IsolatedProcesses processes_;
  std::unordered_map<std::size_t, Running> running_;
  FileHashes hashes_;
  BatchProgress progress_;
  std::size_t most_ = 1;
  Clock::time_point began_ = Clock::now();
};

/// This run's own report last: of equal names its line is looked at first.
ReportIndex BatchRun::read_reports() {
  std::vector<fs::path> reports = report_files(folder_);
  std::erase(reports, report_);
  own_report_ = reports.size();
  reports.push_back(report_);
  return ReportIndex(reports);
}

/// @param before  receives what was baked before, when only a look at the recipe can tell whether
/// it
///                still holds
bool BatchRun::is_there_already(const BatchEntry& entry, std::optional<BatchRecord>& before) {
  const std::string request = begun_record(entry, folder_, options_).request;
  for (const auto& [report, line] : earlier_.lines_of(entry.name)) {
    std::optional<BatchRecord> record = record_from_line(line);
    if (!record || record->name != entry.name || !record->is_done) continue;
    const std::int64_t now = time_now();
    FileHashes output_hashes;
    const Unchanged outputs =
        are_unchanged(record->outputs, folder_, record->written, output_hashes);
    if (!outputs.is_true) continue;
    const Unchanged inputs = are_unchanged(record->inputs, folder_, record->written, hashes_);
    if (!inputs.is_true || record->request != request) {
      if (!before) before = std::move(record);
      continue;
    }
    if (outputs.by_hash || inputs.by_hash) {  // from now on, times will do
      note_times(record->inputs, folder_);
      note_times(record->outputs, folder_);
      record->written = now;
      append_line(report_, record_to_line(*record));
    } else if (report != own_report_) {
      append_line(report_, line);
    }
    return true;
  }
  return false;
}

BatchRun::Step BatchRun::take_next() {
  std::optional<QueuedBake> queued = queue_.next();
  if (!queued) return Step::Nothing;
  Running next{{entry_of(manifest_, queued->entry), folder_, {}}, std::move(queued->makes)};
  if (!next.makes.empty()) return start(queued->entry, std::move(next));
  if (is_there_already(next.job.entry, next.job.before)) {
    ++progress_.done;
    ++progress_.unchanged;
    return Step::Taken;
  }
  const std::string key = options_.cache.is_on() ? keys_.of(next.job.entry) : "";
  if (!key.empty() && !options_.cache.contains(key)) {
    if (queue_.waits(queued->entry, key)) return Step::Taken;
    next.makes = key;
  }
  return start(queued->entry, std::move(next));
}

BatchRun::Step BatchRun::start(std::size_t entry, Running next) {
  const bool is_started = processes_.start(
      entry, [&] { return result_to_text(run_job(next.job, options_, observer_.is_cancelled)); });
  if (!is_started) {
    queue_.put_back({entry, next.makes});
    return Step::NoProcess;
  }
  running_.emplace(entry, std::move(next));
  return Step::Taken;
}

/// What a killed process was writing; nothing when another batch is at the same recipe.
void clean_up(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return;
  const FileLock lock(folder, FileLock::Kind::Alone, false);
  if (!lock.is_held()) return;
  remove_temporaries(folder);
  fs::remove(folder, error);  // fails, as it should, when something is in it
}

void BatchRun::settle(const ProcessOutcome& outcome) {
  const auto found = running_.find(outcome.ticket);
  const Running running = std::move(found->second);
  running_.erase(found);
  std::optional<JobResult> result;
  if (outcome.end == ProcessOutcome::End::Finished) result = result_from_text(outcome.result);
  const bool was_stopped = result && result->kind == JobResult::Kind::Cancelled;
  if (was_stopped && !outcome.was_asked && is_cancelled()) return;
  if (!result && is_cancelled()) {  // what did not stop by itself was killed
    clean_up(folder_ / running.job.entry.name);
    return;
  }
  if (!result || was_stopped) {
    result = JobResult{JobResult::Kind::Failed, begun_record(running.job.entry, folder_, options_)};
    result->record.problems = {crash_of(outcome, options_)};
    result->record.problems.front().location.file = running.job.entry.recipe.string();
    result->record.log = outcome.log;
    result->record.seconds = outcome.seconds;
    clean_up(folder_ / running.job.entry.name);
  }
  if (!running.makes.empty()) queue_.made(running.makes, !result->record.is_done);
  note(*result);
}

void BatchRun::note(const JobResult& result) {
  append_line(report_, record_to_line(result.record));
  ++progress_.done;
  if (result.kind == JobResult::Kind::Unchanged) ++progress_.unchanged;
  if (result.record.is_done) return;
  ++progress_.failed;
  if (observer_.on_failure) observer_.on_failure(result.record);
}

void BatchRun::tell_progress() {
  const std::chrono::duration<double> seconds = Clock::now() - began_;
  const auto baked = static_cast<double>(progress_.done - progress_.unchanged);
  progress_.per_second = baked / std::max(seconds.count(), 1e-3);
  if (baked > 0) {
    const auto left = static_cast<double>(progress_.total - progress_.done);
    progress_.seconds_left = left / progress_.per_second;
  }
  if (observer_.on_progress) observer_.on_progress(progress_);
}

/// Takes what ends by itself and the rest to its end.
void BatchRun::stop() {
  processes_.ask_to_stop();
  while (processes_.running() > 0) {
    for (const ProcessOutcome& outcome : processes_.wait(kTick)) settle(outcome);
  }
}

BatchResult BatchRun::finish(bool is_alone) const {
  const auto lines = [&](const TakeLine& take) {
    const ReportIndex index({report_});
    std::unordered_set<std::string> own;
    for (const std::size_t entry : chosen_) {
      for (const ReportLine& line : index.lines_of(manifest_.names[entry])) take(line.text);
      own.insert(manifest_.names[entry]);
    }
    take_others(index, own, folder_, is_alone, take);
  };
  BatchResult result = write_results(folder_, options_, lines);
  result.progress = progress_;
  return result;
}

BatchResult BatchRun::run() {
  if (options_.memory > 0)
    reserve_blas_memory();  // before the limit, below which it would wait for ever
  if (const FileLock alone(folder_, FileLock::Kind::Alone, false); alone.is_held()) {
    remove_temporaries(folder_);  // of batches that were killed
  }
  auto presence = std::make_optional<FileLock>(folder_, FileLock::Kind::Shared, true);
  make_report(report_);
  while (true) {
    if (is_cancelled()) {
      stop();
      return {progress_, true, options_.folder / report_.filename(), {}, {}};
    }
    const Step step = processes_.running() < most_ ? take_next() : Step::Nothing;
    if (processes_.running() == 0 && step == Step::Nothing) break;
    if (processes_.running() == 0 && step == Step::NoProcess) {
      throw BakeError(Problem{Severity::Error,
                              "batch.no-process",
                              {},
                              "the system gives no process",
                              "there are too many already, or no memory is left"});
    }
    const auto at_most = step == Step::Taken ? std::chrono::milliseconds(0) : kTick;
    for (const ProcessOutcome& outcome : processes_.wait(at_most)) settle(outcome);
    tell_progress();
  }
  presence.reset();
  // Lines of what this list does not have are another run's, if there is one at the same time.
  const FileLock alone(folder_, FileLock::Kind::Alone, false);
  return finish(alone.is_held());
}

}  // namespace

BatchResult run_batch(const Manifest& manifest, const BatchOptions& options,
                      const BatchObserver& observer) {
  try {
    return BatchRun(manifest, options, observer).run();
  } catch (const Cancelled&) {  // before anything was begun
    BatchResult nothing;
    nothing.progress.total = manifest.names.size();
    nothing.is_interrupted = true;
    return nothing;
  }
}

}  // namespace morphbake
