#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <unordered_set>

#include "morphbake/batch/run_batch.h"

namespace morphbake {

/// The folder of a batch, made, as an absolute path without links.
///
/// @throws BakeError "output.unwritable"
std::filesystem::path make_batch_folder(const std::filesystem::path& folder);

using TakeLine = std::function<void(const std::string&)>;

/// Calls back with each line that the report shall have, in order.
using ReportLines = std::function<void(const TakeLine& take)>;

/// Takes the lines of a report for recipes that the list does not have, as long as their outputs
/// are there: of another list into this folder, or of an earlier form of this one.
///
/// @param own       the names that the list has
/// @param is_alone  false: another batch is at work in this folder, all of whose lines are taken
void take_others(const ReportIndex& index, const std::unordered_set<std::string>& own,
                 const std::filesystem::path& folder, bool is_alone, const TakeLine& take);

/// Replaces the report by the lines, writes those that failed once more by themselves, and the
/// page.
///
/// @return  the files, and how many lines are done or failed
/// @throws BakeError "output.unwritable"
BatchResult write_results(const std::filesystem::path& folder, const BatchOptions& options,
                          const ReportLines& lines);

}  // namespace morphbake
