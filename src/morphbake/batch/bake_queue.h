#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace morphbake {

/// An entry of a list whose turn it is.
struct QueuedBake {
  std::size_t entry = 0;
  std::string makes;  ///< the key of what it makes for those that wait; "" before that is known
};

/// The order in which a list is baked: its own, but that recipes wait for what another one makes
/// for them.
class BakeQueue {
 public:
  explicit BakeQueue(std::vector<std::size_t> entries) : entries_(std::move(entries)) {}

  /// The next entry; none when there is none, or all that are left wait.
  std::optional<QueuedBake> next();

  /// Puts an entry back, to be the next one.
  void put_back(QueuedBake bake) { released_.push_front(std::move(bake)); }

  /// An entry needs what has the key `needs`, which is not there: whether another one makes that
  /// and it is to wait; else it is to make it.
  bool waits(std::size_t entry, const std::string& needs);

  /// Who made it has ended. If it failed the next one that waits for it makes it.
  void made(const std::string& key, bool has_failed);

 private:
  std::vector<std::size_t> entries_;
  std::size_t next_ = 0;
  std::deque<QueuedBake> released_;
  std::unordered_map<std::string, std::deque<std::size_t>> waiting_;  ///< by what is being made
};

}  // namespace morphbake
