#pragma once

#include <string_view>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/json.h"

namespace morphbake {

/// One of the files of schemas/, with what it takes from other schemas put in its place.
///
/// Besides draft-07 (without oneOf, anyOf, allOf, if: they make messages vague; and without
/// uniqueItems, for which valijson compares all pairs) a schema says
/// "x-problems" (prefix of its problems' codes), "x-unit", "x-form" (a pattern in words) and
/// "x-default" (a default that is no constant, in words).
/// @param name  "recipe.schema.json"
Json shipped_schema(std::string_view name);

/// Every way in which `document` breaks `schema`, at most 100 of them; none when it is valid.
///
/// valijson decides whether it is valid; the words come from the schema's own description, range
/// and unit.
/// @param schema  made by shipped_schema
/// @param place   file, and pointer at which the document stands in it
/// @return        "<prefix>.unknown-field", ".wrong-type", ".out-of-range", ".missing-field",
/// ".bad-value"
std::vector<Problem> schema_problems(const Json& document, const Json& schema,
                                     const Location& place);

}  // namespace morphbake
