#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"

namespace morphbake {

/// What a stage gave, as it is kept.
struct CacheEntry {
  std::string facts = "{}";        ///< JSON text
  std::vector<std::string> blobs;  ///< what would be large as JSON: files, arrays
};

/// An entry as the bytes of its file: a line with a hash of all that follows, JSON, blobs.
std::string entry_to_bytes(const CacheEntry& entry);

/// @return  none where the bytes are not those that entry_to_bytes gave
std::optional<CacheEntry> entry_from_bytes(std::string_view bytes);

/// Where entries are kept, and how much of them.
struct CacheOptions {
  std::filesystem::path folder;
  std::uintmax_t size_limit = std::uintmax_t{10} << 30;  ///< bytes
};

/// How much a cache holds.
struct CacheContents {
  int entries = 0;
  std::uintmax_t bytes = 0;
};

/// Results of stages by key, in a folder that any number of processes and machines may share.
///
/// Entries appear by renaming and carry a hash of their bytes, so that one that was cut off or
/// damaged is found, told of and made again; nothing is locked. Each sixteenth of the folder stays
/// below a sixteenth of the limit: those that were used least recently go first, and a larger entry
/// is not kept.
class StageCache {
 public:
  /// No cache: finds nothing, keeps nothing.
  StageCache() = default;

  explicit StageCache(CacheOptions options) : options_(std::move(options)) {}

  bool is_on() const { return !options_.folder.empty(); }

  /// Whether there is an entry, be it whole or not.
  bool contains(const std::string& key) const;

  /// The entry, which counts as used. Warns "cache.damaged" of one that is not whole, which goes.
  std::optional<CacheEntry> find(const std::string& key, const Observer& observer) const;

  /// Keeps an entry.
  /// @throws BakeError "output.unwritable"
  void keep(const std::string& key, const CacheEntry& entry) const;

  CacheContents contents() const;

  /// Removes all entries, and nothing else that may be in the folder.
  void clear() const;

  const CacheOptions& options() const { return options_; }

 private:
  std::filesystem::path file_of(const std::string& key) const;
  void make_room(const std::filesystem::path& folder) const;

  CacheOptions options_;
};

}  // namespace morphbake
