#pragma once

#include <string>
#include <utility>
#include <vector>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {

/// What a line of a list says of a recipe.
struct ManifestLine {
  std::string recipe;  ///< as written; "" in a table, which has one recipe for all
  std::string name;    ///< "" where it says none
  std::vector<std::pair<std::string, std::string>> set;  ///< JSON pointers, and values as JSON
};

/// Reads a line of a list of recipes. A line of a batch's report is one as well.
///
/// @throws BakeError "batch.wrong-type", "batch.unknown-field", "batch.missing-field",
/// "json.syntax",
///         ... with the line that `at` has
ManifestLine read_manifest_line(const std::string& text, const Location& at);

/// Reads a line of a table: an object of JSON pointers and "name".
///
/// @throws BakeError likewise, "batch.bad-table"
ManifestLine read_table_line(const std::string& text, const Location& at);

}  // namespace morphbake
