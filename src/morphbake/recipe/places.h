#pragma once

#include <functional>
#include <string>

#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// Whether a place is a point of its source's surface, or wherever something is to go.
enum class Whereabouts { OnSurface, Anywhere };

/// Hears each place of a recipe's regions, handles and gauge: where it is, on which source, and its
/// pointer.
using PlaceVisitor =
    std::function<void(Place& place, int source, const std::string& pointer, Whereabouts where)>;

void visit_places(Recipe& recipe, const PlaceVisitor& visit);

}  // namespace morphbake
