#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "morphbake/bake/load_sources.h"
#include "morphbake/bake/stage_keys.h"
#include "morphbake/cache/stage_cache.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// A stage's entry, and the warnings that the stage gave when it ran.
struct KeptStage {
  CacheEntry entry;
  std::vector<Problem> warnings;
};

/// The cache of one bake, which notes what was taken from it.
///
/// Its faults never stop a bake. Where it cannot be written it warns "cache.unwritable" once and
/// keeps nothing more.
class BakeCache {
 public:
  /// @param cache, recipe, observer  must outlive it
  BakeCache(const StageCache& cache, const Recipe& recipe, const Observer& observer)
      : cache_(cache), recipe_(recipe), observer_(observer), keeps_(cache.is_on()) {}

  bool is_on() const { return cache_.is_on(); }

  const StageCache& entries() const { return cache_; }

  /// The stage as it was kept, its warnings in the words for this recipe; they are not told yet.
  std::optional<KeptStage> find(const StageKey& stage) const;

  /// Notes that what was found is used, and tells its warnings.
  void take(const StageKey& stage, const std::vector<Problem>& warnings, const Observer& observer);

  bool contains(const StageKey& stage) const { return cache_.contains(stage.key); }

  /// @param warnings  of the stage
  /// @param seconds   that it took
  void keep(const StageKey& stage, CacheEntry entry, const std::vector<Problem>& warnings,
            double seconds);

  /// How long a stage took that was made in this bake.
  std::optional<double> seconds_of(const StageKey& stage) const;

  /// Names of the stages that were taken, in order.
  const std::vector<std::string>& taken() const { return taken_; }

 private:
  const StageCache& cache_;
  const Recipe& recipe_;
  const Observer& observer_;
  bool keeps_;
  std::vector<std::string> taken_;
  std::map<std::string, double> seconds_;  // by key
};

/// Where stages look for what is kept, under which keys, and who listens to them.
struct StageContext {
  BakeCache& cache;
  const BakeKeys& keys;
  const Observer& observer;
};

/// Seconds since it was made.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  }

 private:
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

/// The stage's result from the cache, or made and kept.
///
/// @param make      Result(const Observer&), of which entry_of(result) makes an entry
/// @param of_entry  std::optional<Result>(CacheEntry); none where it does not fit
template <typename Make, typename OfEntry>
auto taken_or_made(BakeCache& cache, const StageKey& stage, const Observer& observer,
                   const Make& make, const OfEntry& of_entry) {
  if (std::optional<KeptStage> kept = cache.find(stage)) {
    if (auto result = of_entry(std::move(kept->entry))) {
      cache.take(stage, kept->warnings, observer);
      return std::move(*result);
    }
  }
  const Stopwatch watch;
  std::vector<Problem> warnings;
  auto result = make(recording(observer, warnings));
  if (cache.is_on()) cache.keep(stage, entry_of(result), warnings, watch.seconds());
  return result;
}

}  // namespace morphbake
