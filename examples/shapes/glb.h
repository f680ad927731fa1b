// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesh.h"
#include "unwrap.h"

namespace shapes {

struct Material {
  std::string name;
  double roughness = 0.7;
  bool is_textured = false;  // with the model's texture
};

/// What is drawn with one material. Rows of render vertices; colors and uv may have none.
struct Primitive {
  Material material;
  Rows3d positions;
  Rows3d normals;
  Rows3d colors;
  Rows2d uv;
  Rows3i triangles;
};

struct Model {
  std::vector<Primitive> primitives;
  std::string texture = {};  // a PNG, if any material asks for one
};

/// The whole mesh in its own colours, one render vertex a vertex.
Model painted_model(const Mesh& mesh);

/// Writes one node with one mesh as binary glTF 2.0: POSITION, NORMAL, and COLOR_0 or TEXCOORD_0.
void write_glb(const std::filesystem::path& file, const std::string& name, const Model& model);

}  // namespace shapes
