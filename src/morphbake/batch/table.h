#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "morphbake/batch/manifest.h"

namespace morphbake {

/// What the recipe of a row is called that says no name: "recipe-12".
///
/// @param row  counted from 1
std::string row_name(const std::filesystem::path& recipe, std::size_t row);

/// Rows of a CSV file as changes of a recipe. What is JSON is taken as that, all else as text; an
/// empty cell changes nothing.
///
/// @throws BakeError "batch.bad-table", "batch.bad-name", ... with line and column (cell) of the
/// table
Manifest read_csv_table(const std::filesystem::path& recipe, const std::filesystem::path& table);

}  // namespace morphbake
