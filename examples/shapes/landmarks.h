// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesh.h"
#include "mesher.h"

namespace shapes {

struct Landmark {
  std::string name;
  SurfacePoint at;
};

/// The places on the mesh closest to the hints.
std::vector<Landmark> find_landmarks(const Mesh& mesh, const std::vector<LandmarkHint>& hints);

/// Writes schemas/landmarks.schema.json, version 1.
void write_landmarks(const std::filesystem::path& file, const Mesh& mesh,
                     const std::vector<Landmark>& landmarks);

}  // namespace shapes
