#pragma once

#include <string_view>

namespace morphbake {

// The parts of a library's page that are always the same; its style and its script are in them.
extern const std::string_view kPageStart;
extern const std::string_view kTableStart;
extern const std::string_view kNoSummary;  ///< cells of a recipe that was not baked
extern const std::string_view kPageEnd;

}  // namespace morphbake
