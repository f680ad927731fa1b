#include "morphbake/diff/paired_names.h"

#include <algorithm>
#include <map>

namespace morphbake {
namespace {

/// Where each name stands.
std::map<std::string, std::vector<std::size_t>> places_of(const std::vector<std::string>& names) {
  std::map<std::string, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < names.size(); ++i) places[names[i]].push_back(i);
  return places;
}

}  // namespace

NamePairs paired_names(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  const auto in_a = places_of(a), in_b = places_of(b);
  NamePairs found;
  std::vector<std::size_t> rest_a;
  std::vector<bool> is_taken(b.size(), false);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto other = in_b.find(a[i]);
    const bool is_named = !a[i].empty() && in_a.at(a[i]).size() == 1 && other != in_b.end() &&
                          other->second.size() == 1;
    if (!is_named) {
      rest_a.push_back(i);
      continue;
    }
    found.pairs.emplace_back(i, other->second[0]);
    is_taken[other->second[0]] = true;
  }
  for (std::size_t j = 0; j < b.size(); ++j) {
    if (!is_taken[j]) found.only_b.push_back(j);
  }
  const std::size_t count = std::min(rest_a.size(), found.only_b.size());
  for (std::size_t k = 0; k < count; ++k) found.pairs.emplace_back(rest_a[k], found.only_b[k]);
  const auto taken = static_cast<std::ptrdiff_t>(count);
  found.only_a.assign(rest_a.begin() + taken, rest_a.end());
  found.only_b.erase(found.only_b.begin(), found.only_b.begin() + taken);
  std::sort(found.pairs.begin(), found.pairs.end());
  return found;
}

}  // namespace morphbake
