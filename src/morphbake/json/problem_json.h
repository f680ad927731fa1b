#pragma once

#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/json.h"

namespace morphbake {

/// A problem as reports and logs have it; line and column where they are known.
Json problem_to_json(const Problem& problem);

Json problems_to_json(const std::vector<Problem>& problems);

}  // namespace morphbake
