// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solid.h"

namespace shapes {

/// Linear colour of a solid at p with the grain of its fabrics: tufts and strands of fur, stitches
/// of wool. The same on every machine: noise comes from whole numbers.
Vector coat_color(const Solid& solid, const Vector& p);

}  // namespace shapes
