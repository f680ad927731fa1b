#pragma once

#include <string>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/json.h"

namespace morphbake {

constexpr std::size_t problems_limit = 100;

/// The part of a schema that `node` stands for: itself, or what its "$ref" names.
const Json& referred(const Json& schema, const Json& node);

/// Compares `document` with `schema` and says in words what is wrong; stops after problems_limit.
///
/// Knows the keywords that our schemas use; schema_problems() reports what else valijson finds.
std::vector<Problem> explain(const Json& document, const Json& schema, const Location& place);

}  // namespace morphbake
