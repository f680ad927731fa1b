#pragma once

#include <optional>
#include <string>
#include <variant>

namespace morphbake {

/// A name or an index from 0, as glTF counts; or no choice.
using NameOrIndex = std::variant<std::monostate, std::string, int>;

inline bool is_chosen(const NameOrIndex& choice) {
  return !std::holds_alternative<std::monostate>(choice);
}

/// A moment of an animation.
struct Moment {
  NameOrIndex animation;  ///< none: the first
  double time = 0;        ///< seconds
};

/// Which mesh of a file is meant, and in which shape.
struct MeshChoice {
  NameOrIndex node = {};    ///< none: the only one with a mesh
  NameOrIndex mesh = {};    ///< none: that of the node
  NameOrIndex target = {};  ///< a morph target that is fully on, all others off; none: as at rest
  std::optional<Moment> moment = {};  ///< its morph weights, and its skeleton's pose
};

}  // namespace morphbake
