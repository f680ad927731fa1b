#pragma once

// Internal to gltf/: channels of the extension KHR_animation_pointer, which name what they move by
// a JSON pointer.

#include <cstddef>
#include <optional>
#include <string>

#include "morphbake/gltf/document.h"

namespace morphbake {

/// "/nodes/3/weights" is {"nodes", 3, "weights"}.
struct PointedProperty {
  std::string list;
  std::size_t index = 0;
  std::string property;
};

/// What a channel's target points to; nothing where it points nowhere, or deeper.
///
/// @param target  JSON of a channel's target
std::optional<PointedProperty> pointed_property(const Json& target);

/// Makes channels that point to what plain channels can move those plain channels: transforms and
/// weights of nodes; weights of a mesh for each node that shows it and has no weights of its own.
///
/// @param document  with its JSON and model
/// @throws BakeError "gltf.too-large" when such channels move more than 131072 nodes in all
void follow_pointers(GltfDocument& document);

}  // namespace morphbake
