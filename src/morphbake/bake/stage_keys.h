#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "morphbake/bake/options.h"
#include "morphbake/cache/content_hash.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// What is known of the files that recipes read, each of which is looked at once.
struct InputFiles {
  FileHashes hashes;
  std::map<std::filesystem::path, std::vector<std::filesystem::path>> beside;  ///< as files_beside
};

/// What decides the result of a stage. Descriptions of stages contain keys of those before.
struct StageKey {
  std::string name;         ///< "connectivity", "regions", "output a.glb", ...
  std::string description;  ///< JSON text: options, contents of files, the program
  std::string key;          ///< hash of the description, 32 hexadecimal digits
};

/// The keys of all that a bake keeps.
struct BakeKeys {
  StageKey connectivity;
  StageKey regions;
  StageKey derived;  ///< sources that are made from others
  StageKey shapes;   ///< of the timeline, but for the numbers that they come from
  StageKey solve;
  std::vector<StageKey> outputs;
  std::vector<StageKey> previews;  ///< one an output; of recipes with previews
  StageKey maps;  ///< pictures that explain the recipe; of recipes that ask for such
};

/// Keys of nothing: for a bake without a cache.
BakeKeys no_keys(const Recipe& recipe);

/// @throws BakeError as file_hash, of files that are there no more
BakeKeys bake_keys(const Recipe& recipe, const BakeOptions& options, InputFiles& files);

/// The key of the stage `connectivity` alone: what recipes share that share their work there.
std::string connectivity_key(const Recipe& recipe, InputFiles& files);

/// One key of all that decides the bytes of a recipe's outputs, where they are called as it says.
std::string bake_key(const BakeKeys& keys);

/// All files that a bake reads, and those that it would read if they were there: parts of the
/// recipe, profiles, landmarks, masks, meshes with their buffers and images. Absolute, each once.
std::vector<std::filesystem::path> files_read_by(const Recipe& recipe, InputFiles& files);

}  // namespace morphbake
