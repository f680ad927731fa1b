#pragma once

#include <functional>
#include <string>

#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// Hears each place of a recipe's regions and gauge: where it is, on which source, and its pointer.
using PlaceVisitor = std::function<void(Place& place, int source, const std::string& pointer)>;

void visit_places(Recipe& recipe, const PlaceVisitor& visit);

}  // namespace morphbake
