#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "morphbake/batch/batch_options.h"
#include "morphbake/batch/batch_record.h"
#include "morphbake/batch/manifest.h"

namespace morphbake {

/// One recipe that is to be baked.
struct BakeJob {
  BatchEntry entry;
  std::filesystem::path folder;       ///< of the batch: absolute
  std::optional<BatchRecord> before;  ///< what an earlier run noted, if its outputs are still there
};

/// A record with what is known of a recipe before it is baked: name, file, changes, request.
BatchRecord begun_record(const BatchEntry& entry, const std::filesystem::path& folder,
                         const BatchOptions& options);

/// How a job ended.
struct JobResult {
  enum class Kind { Baked, Unchanged, Failed, Cancelled };

  Kind kind = Kind::Failed;
  BatchRecord record;
};

/// Bakes a recipe, or finds that what is there is what it would give. Everything that can go wrong
/// comes back as a failure.
JobResult run_job(const BakeJob& job, const BatchOptions& options,
                  const std::function<bool()>& is_cancelled);

/// A result as it goes from process to process.
std::string result_to_text(const JobResult& result);

/// @return  none where the text is no result
std::optional<JobResult> result_from_text(const std::string& text);

}  // namespace morphbake
