#pragma once

#include <string>
#include <utility>
#include <vector>

namespace morphbake {

/// Things of two lists that belong together.
struct NamePairs {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< rising in the first list
  std::vector<std::size_t> only_a;
  std::vector<std::size_t> only_b;
};

/// Pairs what both lists have once under one name, then the rest in order.
NamePairs paired_names(const std::vector<std::string>& a, const std::vector<std::string>& b);

}  // namespace morphbake
