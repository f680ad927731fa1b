#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace morphbake {

/// The candidate that `name` was probably meant to be, or "" when none is close.
///
/// Close: at most a third of its letters inserted, removed, replaced or swapped with their
/// neighbour; capital letters count as small ones.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// "a, b, c", cut after a dozen.
std::string name_list(const std::vector<std::string>& names);

/// `did you mean "nose"? regions are: nose, rest`
///
/// @param kind  what the candidates are, in the plural: "regions"
std::string name_hint(std::string_view name, const std::vector<std::string>& candidates,
                      std::string_view kind);

}  // namespace morphbake
