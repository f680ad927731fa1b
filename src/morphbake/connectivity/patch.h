#pragma once

#include <vector>

namespace morphbake {

/// The part of a triangulation that a step may change; vertices that are added belong to it.
struct Patch {
  std::vector<char> vertices;  ///< one a vertex slot; empty: everything

  bool has(int vertex) const {
    const auto slot = static_cast<std::size_t>(vertex);
    return slot >= vertices.size() || vertices[slot] != 0;
  }
};

}  // namespace morphbake
