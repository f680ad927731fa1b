#include "morphbake/json/nearest.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

namespace morphbake {
namespace {

constexpr std::size_t listed_names = 12;
constexpr std::size_t longest_compared = 256;

std::string small_letters(std::string_view text) {
  std::string small(text);
  for (char& letter : small) {
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return small;
}

/// Insertions, removals, replacements and swaps of neighbours that lead from `a` to `b` (optimal
/// string alignment: no byte is edited twice).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, above);
    std::swap(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  if (name.size() > longest_compared) return "";
  const std::string wanted = small_letters(name);
  std::size_t best = std::max<std::size_t>(1, name.size() / 3) + 1;
  std::string nearest;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > longest_compared) continue;
    const std::size_t distance = edit_distance(wanted, small_letters(candidate));
    // A name of one or two letters is near everything: it must share a letter.
    if (distance < best && distance < candidate.size()) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string name_list(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), listed_names); ++i) {
    list += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > listed_names) {
    list += fmt::format(" and {} more", names.size() - listed_names);
  }
  return list;
}

std::string name_hint(std::string_view name, const std::vector<std::string>& candidates,
                      std::string_view kind) {
  if (candidates.empty()) return fmt::format("there are no {}", kind);
  const std::string nearest = nearest_name(name, candidates);
  const std::string question = nearest.empty() ? "" : fmt::format("did you mean \"{}\"? ", nearest);
  return fmt::format("{}{} are: {}", question, kind, name_list(candidates));
}

}  // namespace morphbake
