#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/recipe/landmark.h"

namespace morphbake {

/// The landmarks of a file as schemas/landmarks.schema.json describes it, in its order.
///
/// @param name  what messages call the file
/// @throws BakeError with all problems found: "landmarks.conflicting-fields",
///         "landmarks.bad-shares", "landmarks.missing-field", "landmarks.out-of-range", ...
std::vector<Landmark> read_landmarks(const std::filesystem::path& file, const std::string& name);

/// <folder>/<stem>.landmarks.json of a source.
std::filesystem::path landmarks_beside(const std::filesystem::path& source);

/// Text of a landmark file, which read_landmarks reads back exactly.
///
/// @param landmarks  of different names
/// @param file       where it will be written
/// @param schema     landmarks.schema.json for "$schema", by which editors complete; empty for none
std::string landmarks_to_json(const std::vector<Landmark>& landmarks,
                              const std::filesystem::path& file,
                              const std::filesystem::path& schema);

}  // namespace morphbake
