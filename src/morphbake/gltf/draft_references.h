#pragma once

// Internal to gltf/: what in a draft refers to its accessors and bufferViews, whose numbers are all
// that glTF knows them by.

#include <vector>

#include "morphbake/gltf/glb_draft.h"

namespace morphbake {

/// How often a draft refers to each of its parts.
struct References {
  std::vector<int> accessors;  ///< by attributes, targets, indices, samplers and skins
  std::vector<int> views;      ///< by whatever has a field "bufferView"
  /// Whether that is all: an extension that nobody here knows may refer to any part by any field,
  /// and so may an application's extras. Then every part keeps its number and its bytes.
  bool are_all = true;
};

References references_in(const GlbDraft& draft);

/// What was taken out of use.
struct Released {
  bool is_unused = false;  ///< the accessor: nothing refers to it any more
  int view = -1;           ///< its bufferView, when nothing else has it; else -1
};

/// Takes away references to an accessor; without any left, it and what only it has are left over.
Released release_accessor(GlbDraft& draft, References& references, int accessor, int count);

/// Takes away an accessor's references to its bufferViews; returns Released::view.
int release_views(GlbDraft& draft, References& references, const Json& accessor);

/// Takes away a reference to a bufferView. @return whether it was the last one
bool release_view(GlbDraft& draft, References& references, std::size_t view);

/// Adds a bufferView: in place of what release_views() told, with its name and extras, or where one
/// is left over or at the end when that told none; returns its index.
int replace_view(GlbDraft& draft, References& references, int released, Json view);

/// Copies the fields that neither numbers nor their form depend on.
void keep_fields(const Json& from, Json& to);

/// Takes the parts that are left over out of their lists, and their bytes out of the buffer.
void remove_leftovers(GlbDraft& draft);

}  // namespace morphbake
