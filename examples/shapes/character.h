// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "glb.h"
#include "landmarks.h"
#include "mesh.h"
#include "variants.h"

namespace shapes {

/// One look of a character: a body, a hat that lies loose on it, and their proportions.
struct Look {
  Solid body, hat;  // of one shape in all looks, each look in its own colours
  Variant build;    // moves the groups of both; its name is the look's
};

/// A look as it is written.
struct Dressed {
  std::string name;
  Mesh mesh;  // body and hat, two pieces
  Model model;
  std::vector<Landmark> landmarks;
};

/// Meshes, unwraps and paints a character. All looks have the same triangles, seams and landmarks.
///
/// The first look's shapes are meshed. Each group of parts is cut into front and back; every fabric
/// is a primitive: fur and wool share the texture, gloss has the colours of its vertices.
std::vector<Dressed> dressed(const std::vector<Look>& looks);

}  // namespace shapes
