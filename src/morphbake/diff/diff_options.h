#pragma once

#include <optional>

#include "morphbake/gltf/mesh_choice.h"

namespace morphbake {

/// What counts as a difference between two files.
struct DiffOptions {
  /// Scene units (metres in glTF), >= 0: how far a vertex may be from its place. Where `relative`
  /// is given as well, the larger of both holds.
  std::optional<double> absolute = {};

  /// The same as a fraction of the bounding-box diagonal of the first file's first frame, >= 0.
  /// 1e-5 where neither is given.
  std::optional<double> relative = {};

  /// Degrees, 0 to 180: how far a normal may be turned. Not given: 0.1, and only where both files
  /// have the same targets with the same weights, for normals are not linear in the weights.
  std::optional<double> normal_angle = {};

  /// How far numbers of other attributes, of materials and of COLOR_0 may be apart, in their own
  /// units, >= 0.
  double attribute = 1e-5;

  /// Whether names and weights of targets count, normals always, and the time between the frames of
  /// a sampled motion as much as the frames.
  bool strict = false;

  NameOrIndex node = {};  ///< whose mesh, in each file; none: all meshes of the scene
  int threads = 0;        ///< 0: all cores; never changes a bit of the result
};

constexpr double kDefaultRelative = 1e-5;
constexpr double kDefaultNormalAngle = 0.1;

}  // namespace morphbake
