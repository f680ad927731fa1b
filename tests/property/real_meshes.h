#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake::test {

/// Whether the team's meshes lie beside the project; a user has none of them.
inline bool has_real_meshes() {
  return std::filesystem::exists(std::string(MORPHBAKE_SHARED_DIR) + "/meshes");
}

/// Files of one set ("set-mh-faces/mhface_male_baby") on their shared connectivity.
inline MorphableMesh real_mesh(const std::vector<std::string>& names) {
  std::vector<SourceMesh> sources;
  for (const std::string& name : names) {
    const std::filesystem::path file =
        std::filesystem::path(MORPHBAKE_SHARED_DIR) / "meshes" / (name + ".glb");
    sources.push_back(load_source({name, file, {}, {}}));
  }
  return share_connectivity(sources);
}

}  // namespace morphbake::test
