#pragma once

// Internal to gltf/: new numbers in place of old ones, without harm to whoever else uses those.

#include <cstddef>

#include "morphbake/gltf/draft_references.h"

namespace morphbake {

/// An accessor, and how many of the references to it are to have the new numbers.
struct Replaced {
  int accessor = 0;
  int references = 0;
};

/// Numbers that become an accessor of floats.
struct NewNumbers {
  const float* data = nullptr;
  std::size_t count = 0;  ///< elements
  int columns = 1;        ///< 1, 3 or 4
  BufferUse use = BufferUse::Vertices;
};

/// Adds numbers and returns their accessor: the same as before, with its name and extras, unless
/// others refer to it too.
///
/// @param references  of the draft; they become those after this
int replace_accessor(GlbDraft& draft, References& references, const Replaced& old,
                     const NewNumbers& numbers);

}  // namespace morphbake
