#include "morphbake/batch/bake_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

#include "morphbake/bake/bake.h"
#include "morphbake/bake/stage_keys.h"
#include "morphbake/batch/file_states.h"
#include "morphbake/diagnostics/bug.h"
#include "morphbake/files/file_lock.h"
#include "morphbake/files/files.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// A recipe, ready to be baked.
struct ReadyRecipe {
  Recipe recipe;
  BakeOptions options;
};

ReadyRecipe read_job(const BakeJob& job, const BatchOptions& options) {
  Recipe recipe = read_recipe(job.entry.recipe, job.entry.changes);
  BakeOptions bake_options =
      read_options(recipe.options, location_in(recipe, "/options").file, options.settings);
  bake_options.threads = options.threads;
  recipe = redirect_outputs(std::move(recipe), job.folder / job.entry.name);
  if (!options.with_previews) recipe.preview.reset();
  return {std::move(recipe), bake_options};
}

BakeSummary summary_of(const BakeReport& report) {
  BakeSummary summary;
  summary.vertices = report.vertices;
  summary.triangles = report.triangles;
  summary.frames = report.frames;
  for (const OutputReport& output : report.outputs) {
    summary.targets += static_cast<int>(output.targets.size());
    summary.bytes += output.bytes;
    summary.max_error = std::max(summary.max_error, output.max_error);
    summary.normal_error = std::max(summary.normal_error, output.normals.maximum);
  }
  summary.stages = report.stages;
  summary.cached = report.cached;
  return summary;
}

std::vector<FileState> outputs_of(const BakeReport& report, const fs::path& folder) {
  FileHashes hashes;
  std::vector<FileState> states;
  for (const OutputReport& output : report.outputs) {
    states.push_back(state_of(output.file, folder, hashes));
    for (const fs::path& preview : output.previews) {
      states.push_back(state_of(preview, folder, hashes));
    }
  }
  return states;
}

/// Removes what an earlier bake wrote and this one does not, as long as nobody has changed it.
void remove_old_outputs(const BatchRecord& before, const std::vector<FileState>& now,
                        const fs::path& folder) {
  for (const FileState& old : before.outputs) {
    const bool is_again =
        std::ranges::any_of(now, [&](const FileState& state) { return state.file == old.file; });
    FileHashes hashes;
    if (is_again || !are_unchanged({old}, folder, before.written, hashes).is_true) continue;
    std::error_code ignored;
    fs::remove(folder / old.file, ignored);
  }
}

/// The folder of a recipe's outputs, which no other batch may bake into meanwhile.
class OutputFolder {
 public:
  explicit OutputFolder(const fs::path& folder)
      : folder_(made(folder)), lock_(folder_, FileLock::Kind::Alone, true) {
    if (lock_.is_held()) remove_temporaries(folder_);  // of bakes that were killed
  }

  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  ~OutputFolder() {
    std::error_code error;
    if (!fs::is_directory(folder_, error)) return;  // a file of that name is somebody's
    fs::remove(folder_, error);                     // fails, as it should, when something is in it
  }

 private:
  static const fs::path& made(const fs::path& folder) {
    std::error_code ignored;  // whoever writes into it tells
    fs::create_directories(folder, ignored);
    return folder;
  }

  fs::path folder_;
  FileLock lock_;
};

/// A key of the outputs' bytes and of what they are called.
std::string key_with_names(const std::string& key, const Recipe& recipe) {
  Json named = {key};
  for (const Output& output : recipe.outputs) named.push_back(output.file.filename().string());
  return content_hash(named.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// Fills in what the bake, or a look at its files, gives.
JobResult::Kind bake_into(BatchRecord& record, const BakeJob& job, const BatchOptions& options,
                          const std::function<bool()>& is_cancelled) {
  const auto [recipe, bake_options] = read_job(job, options);
  record.written = time_now();  // before anything is read: what changes later is seen
  InputFiles files;
  for (const fs::path& file : files_read_by(recipe, files)) {
    record.inputs.push_back(state_of(file, job.folder, files.hashes));
  }
  const BakeKeys keys = bake_keys(recipe, bake_options, files);
  record.key = key_with_names(bake_key(keys), recipe);
  record.connectivity = keys.connectivity.key;
  const OutputFolder output_folder(job.folder / job.entry.name);
  if (job.before && job.before->key == record.key) {
    record.summary = job.before->summary;
    record.problems = job.before->problems;
    record.outputs = job.before->outputs;
    return JobResult::Kind::Unchanged;
  }
  Observer observer;
  observer.is_cancelled = is_cancelled;
  const BakeReport report = bake(recipe, bake_options, options.cache, observer);
  record.summary = summary_of(report);
  record.problems = report.problems;
  record.outputs = outputs_of(report, job.folder);
  if (job.before) remove_old_outputs(*job.before, record.outputs, job.folder);
  return JobResult::Kind::Baked;
}

std::string set_of(const BatchEntry& entry) {
  if (entry.changes.empty()) return "";
  Json set = Json::object();
  for (const RecipeChange& change : entry.changes) {
    set[change.pointer] = parse_json(change.value, change.at.file);
  }
  return set.dump();
}

Problem out_of_memory(const BatchEntry& entry) {
  return {Severity::Error,
          "memory.exhausted",
          {entry.recipe.string(), "", 0, 0},
          "not enough memory",
          "allow more with --memory, run fewer at once (-j), or bake smaller meshes"};
}

}  // namespace

BatchRecord begun_record(const BatchEntry& entry, const fs::path& folder,
                         const BatchOptions& options) {
  BatchRecord record;
  record.name = entry.name;
  record.recipe = fs::proximate(entry.recipe, folder).string();
  record.set = set_of(entry);
  record.written = time_now();
  const Json request = {{"program", program_hash()},
                        {"recipe", record.recipe},
                        {"set", record.set},
                        {"settings", options.settings},
                        {"previews", options.with_previews}};
  record.request = content_hash(request.dump());
  return record;
}

JobResult run_job(const BakeJob& job, const BatchOptions& options,
                  const std::function<bool()>& is_cancelled) {
  const auto began = std::chrono::steady_clock::now();
  JobResult result;
  try {
    result.record = begun_record(job.entry, job.folder, options);
    result.kind = bake_into(result.record, job, options, is_cancelled);
    result.record.is_done = true;
  } catch (const Cancelled&) {
    result.kind = JobResult::Kind::Cancelled;
  } catch (const BakeError& error) {
    result.record.problems = error.problems();
  } catch (const std::bad_alloc&) {
    result.record.problems = {out_of_memory(job.entry)};
  } catch (const std::exception& error) {
    Problem problem = bug(error.what());
    problem.location.file = job.entry.recipe.string();
    result.record.problems = {std::move(problem)};
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
  const bool is_as_before = result.kind == JobResult::Kind::Unchanged;
  result.record.seconds = is_as_before ? job.before->seconds : seconds.count();
  return result;
}

namespace {

constexpr std::string_view kKinds = "BUFC";  // in the order of JobResult::Kind

}  // namespace

std::string result_to_text(const JobResult& result) {
  return kKinds[static_cast<std::size_t>(result.kind)] + record_to_line(result.record);
}

std::optional<JobResult> result_from_text(const std::string& text) {
  const std::size_t kind = text.empty() ? std::string_view::npos : kKinds.find(text.front());
  if (kind == std::string_view::npos) return {};
  std::optional<BatchRecord> record = record_from_line(text.substr(1));
  if (!record) return {};
  return JobResult{static_cast<JobResult::Kind>(kind), std::move(*record)};
}

}  // namespace morphbake
