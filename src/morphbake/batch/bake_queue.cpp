#include "morphbake/batch/bake_queue.h"

#include <utility>

namespace morphbake {

std::optional<QueuedBake> BakeQueue::next() {
  if (!released_.empty()) {
    QueuedBake bake = std::move(released_.front());
    released_.pop_front();
    return bake;
  }
  if (next_ == entries_.size()) return {};
  return QueuedBake{entries_[next_++], ""};
}

bool BakeQueue::waits(std::size_t entry, const std::string& needs) {
  const auto [made, is_new] = waiting_.try_emplace(needs);
  if (!is_new) made->second.push_back(entry);
  return !is_new;
}

void BakeQueue::made(const std::string& key, bool has_failed) {
  const auto found = waiting_.find(key);
  if (found == waiting_.end()) return;
  std::deque<std::size_t>& waiting = found->second;
  if (has_failed && !waiting.empty()) {
    released_.push_back({waiting.front(), key});
    waiting.pop_front();
    return;
  }
  for (const std::size_t entry : waiting) released_.push_back({entry, ""});
  waiting_.erase(found);
}

}  // namespace morphbake
