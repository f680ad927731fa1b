#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "morphbake/batch/batch_options.h"
#include "morphbake/batch/batch_record.h"
#include "morphbake/batch/manifest.h"

namespace morphbake {

/// How far a batch is.
struct BatchProgress {
  std::size_t total = 0;
  std::size_t done = 0;  ///< with those that were unchanged, and those that failed
  std::size_t failed = 0;
  std::size_t unchanged = 0;           ///< was there already
  double per_second = 0;               ///< recipes that were baked
  std::optional<double> seconds_left;  ///< none before the first has ended
};

/// What the caller of a batch wants to hear. Every function may be empty.
struct BatchObserver {
  std::function<void(const BatchRecord&)> on_failure;
  std::function<void(const BatchProgress&)> on_progress;
  std::function<bool()> is_cancelled;  ///< asked in the processes of the recipes as well
};

/// What became of a batch.
struct BatchResult {
  BatchProgress progress;
  bool is_interrupted = false;     ///< then the report has what was done, in no order
  std::filesystem::path report;    ///< a line a recipe
  std::filesystem::path failures;  ///< the lines of those that failed
  std::filesystem::path page;      ///< "" without one
};

/// Bakes a list of recipes, each in a process of its own, into folders of their names.
///
/// What an earlier run has baked is left as it is if all that went into it is unchanged. The report
/// is written as recipes end, so that whatever ends this process loses only those that it was at.
/// This process may have no other thread at work.
/// @throws BakeError "output.unwritable", "batch.no-process"
BatchResult run_batch(const Manifest& manifest, const BatchOptions& options,
                      const BatchObserver& observer);

/// Joins the reports of all shards; bakes nothing. A recipe without a line failed: "batch.missing".
///
/// @throws BakeError "output.unwritable"
BatchResult collect_batch(const Manifest& manifest, const BatchOptions& options,
                          const BatchObserver& observer);

}  // namespace morphbake
