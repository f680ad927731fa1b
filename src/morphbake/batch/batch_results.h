#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

#include "morphbake/batch/run_batch.h"

namespace morphbake {

/// The folder of a batch, made, as an absolute path without links.
///
/// @throws BakeError "output.unwritable"
std::filesystem::path make_batch_folder(const std::filesystem::path& folder);

/// Calls back with each line that the report shall have, in order.
using ReportLines = std::function<void(const std::function<void(const std::string&)>& take)>;

/// Replaces the report by the lines, writes those that failed once more by themselves, and the page.
///
/// @return  the files, and how many lines are done or failed
/// @throws BakeError "output.unwritable"
BatchResult write_results(const std::filesystem::path& folder, const BatchOptions& options,
                          const ReportLines& lines);

}  // namespace morphbake
