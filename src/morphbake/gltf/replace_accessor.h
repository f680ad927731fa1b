#pragma once

// Internal to gltf/: new numbers in place of old ones, without harm to whoever else uses those.

#include <cstddef>
#include <vector>

#include "morphbake/gltf/glb_draft.h"

namespace morphbake {

/// How often a draft refers to each of its parts.
struct References {
  std::vector<int> accessors;  ///< by attributes, targets, indices, samplers and skins
  std::vector<int> views;      ///< by whatever has a field "bufferView"
};

References references_in(const GlbDraft& draft);

/// An accessor, and how many of the references to it are to have the new numbers.
struct Replaced {
  int accessor = 0;
  int references = 0;
};

/// Numbers that become an accessor of floats.
struct NewNumbers {
  const float* data = nullptr;
  std::size_t count = 0;  ///< elements
  int columns = 1;        ///< 1 or 3
  BufferUse use = BufferUse::Vertices;
};

/// Appends numbers and returns their accessor: the same as before, with its name and extras, unless
/// others refer to it too. No bufferView is left over.
///
/// @param before  references_in(draft) before anything was added
int replace_accessor(GlbDraft& draft, const References& before, const Replaced& old,
                     const NewNumbers& numbers);

}  // namespace morphbake
