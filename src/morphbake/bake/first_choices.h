#pragma once

#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake {

/// What a first recipe over the sources of `draft` has to say so that it bakes: whether they need
/// new triangles, and which of them stand elsewhere or have another size than the first one.
///
/// @throws BakeError "landmarks.too-few" when new triangles are needed and fewer than three
///         landmarks are common: the hint is the command that proposes them; as load_sources and
///         share_connectivity
FirstChoices first_choices(const Recipe& draft, const Observer& observer);

}  // namespace morphbake
