#pragma once

#include <vector>

#include "morphbake/gltf/animated_mesh.h"

namespace morphbake {

/// Curves of `a` and `b` that are looked at together.
struct CurvePair {
  const AnimationCurve& a;
  const AnimationCurve& b;
};

/// One time at which two files are compared. Keys that are the same but for rounding are one
/// instant, at which each file stands at its own key.
struct Instant {
  double time_a = 0;  ///< seconds
  double time_b = 0;  ///< seconds, a millionth from time_a at most
  bool is_key_a = false;
  bool is_key_b = false;
};

/// All keys of both, and the middles between neighbouring ones, rising. At least one.
std::vector<Instant> common_instants(const CurvePair& curves);

/// Whether a curve shows a motion by frames: five linear keys or more, evenly apart (the first and
/// the last may lie closer). What it is between two of them is not told by the file, but by
/// straight lines.
bool is_sampled(const AnimationCurve& curve);

/// Whether both have the same keys, but for rounding.
bool have_same_keys(const CurvePair& curves);

}  // namespace morphbake
