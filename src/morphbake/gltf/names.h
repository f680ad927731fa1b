#pragma once

// Internal to gltf/: things of a file that a user names.

#include <string>
#include <vector>

#include "morphbake/gltf/document.h"
#include "morphbake/gltf/mesh_choice.h"

namespace morphbake {

/// Index of what is chosen among things that have names, not all of them unique or not empty.
///
/// @param kind     "node": the code is "gltf.no-such-node"
/// @param pointer  of the list, for messages
/// @throws BakeError "gltf.no-such-<kind>" when there is none, or several of that name
int index_of_choice(const GltfDocument& document, const NameOrIndex& choice,
                    const std::vector<std::string>& names, const std::string& kind,
                    const std::string& pointer);

/// The names of things, for index_of_choice.
template <typename Item>
std::vector<std::string> names_of(const std::vector<Item>& items) {
  std::vector<std::string> names;
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

}  // namespace morphbake
