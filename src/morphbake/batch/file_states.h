#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "morphbake/batch/batch_record.h"
#include "morphbake/cache/content_hash.h"

namespace morphbake {

/// Nanoseconds since 1970 by this machine's clock.
std::int64_t time_now();

/// How a file is now, called from `folder` on.
///
/// @param hashes  remembers the hashes of files that several recipes read
FileState state_of(const std::filesystem::path& file, const std::filesystem::path& folder,
                   FileHashes& hashes);

/// Whether files are as they were noted, and what was looked at to see it.
struct Unchanged {
  bool is_true = true;
  bool by_hash = false;  ///< some were read: their times alone could not tell
};

/// Compares files with what was noted of them at the time `written`.
///
/// A size and a time of change that are those noted tell that a file is unchanged, but for one that
/// was changed in the 2 s before `written` or later, by its own file system's clock: it may have
/// been changed again within a tick of that clock, so that its hash decides. Times are compared for
/// being equal only: where clocks are wrong, more is hashed, and nothing stale passes.
Unchanged are_unchanged(const std::vector<FileState>& states, const std::filesystem::path& folder,
                        std::int64_t written, FileHashes& hashes);

/// Notes the times of files that are unchanged.
void note_times(std::vector<FileState>& states, const std::filesystem::path& folder);

}  // namespace morphbake
