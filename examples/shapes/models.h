// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "character.h"
#include "mesh.h"
#include "solid.h"
#include "variants.h"

namespace shapes {

// Every model stands on y = 0 and faces +Z; left is +X. Lengths in metres.

Solid egg();
Solid giraffe();
Solid horse();
Solid bird();
Solid cow();
Solid pig();

Family faces();      // face, face_long_nose, face_short_nose
Family creatures();  // creature_base, creature_thin, creature_stout

std::vector<Look> foxes();  // fox, fennec

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

/// bar_straight and bar_bent_twisted: 120 degrees of bend, 270 of twist; regular triangles.
std::vector<NamedMesh> bars();

}  // namespace shapes
