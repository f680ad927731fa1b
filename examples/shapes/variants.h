// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "mesh.h"
#include "solid.h"

namespace shapes {

/// What happens to what is near one group of parts: scaled about a point, then shifted.
struct Stretch {
  std::string group;  // empty: everything alike
  Vector scale;
  Vector about;
  Vector shift{0, 0, 0};
};

/// A solid in other proportions. Groups without a stretch stay; the one for all comes last.
struct Variant {
  std::string name;
  std::vector<Stretch> stretches;
};

struct Family {
  Solid base;
  std::vector<Variant> variants = {};
};

/// The mesh of the base in the proportions of the variant: same vertices, same triangles.
///
/// Each vertex follows the groups near it, as in skinning; the weights are smooth, so is the
/// result.
Mesh varied(const Mesh& mesh, const Solid& base, const Variant& variant);

}  // namespace shapes
