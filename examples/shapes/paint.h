// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "field.h"
#include "unwrap.h"

namespace shapes {

/// Linear colour of a place on the surface, which lies in the given triangle.
using Painter = std::function<Vector(int triangle, const Vector& at)>;

/// Paints the texture of an unwrapped surface: a square PNG, sRGB.
///
/// Every texel takes the colour of its place in space, so both sides of a seam agree. Paint runs
/// over the charts' edges and fills what no chart covers, for filters and smaller mip levels.
/// @throws std::runtime_error when charts overlap
std::string paint(const Mesh& mesh, const Unwrapped& flat, int size, const Painter& painter);

}  // namespace shapes
