#pragma once

#include <string>
#include <vector>

#include "morphbake/connectivity/mesh_health.h"
#include "morphbake/json/json.h"

namespace morphbake::cli {

/// The health of a mesh in plain words: what it is, then a line for each thing that a bake mends,
/// warns of or refuses, with the first places and what helps.
std::vector<std::string> health_lines(const MeshHealth& health);

/// All of it, for programs.
Json health_json(const MeshHealth& health);

}  // namespace morphbake::cli
