// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "mesh.h"

namespace shapes {

/// Writes one mesh with POSITION, NORMAL and COLOR_0 as binary glTF 2.0.
void write_glb(const std::filesystem::path& file, const std::string& name, const Mesh& mesh);

}  // namespace shapes
