#pragma once

#include <memory>
#include <string>
#include <utility>

#include "morphbake/gltf/document.h"
#include "morphbake/sources/source_mesh.h"
#include "shapes/shapes.h"

namespace morphbake::test {

/// A source as load_source makes it, of a file that is empty and called NAME.glb.
inline SourceMesh source_of(const Mesh& mesh, const std::string& name) {
  SourceMesh source;
  source.name = name;
  auto file = std::make_shared<GltfDocument>();
  file->file = name + ".glb";
  source.file = std::move(file);
  source.positions = mesh.positions;
  source.triangles = mesh.triangles;
  source.welded = weld_rows(source.positions, source.welded_count);
  return source;
}

/// Every triangle with vertices of its own: what flat shading exports.
inline Mesh split_apart(const Mesh& mesh) {
  Mesh split{Positions(mesh.triangles.size(), 3), Triangles(mesh.triangles.rows(), 3)};
  for (Eigen::Index c = 0; c < mesh.triangles.size(); ++c) {
    split.positions.row(c) = mesh.positions.row(mesh.triangles.data()[c]);
    split.triangles.data()[c] = static_cast<int>(c);
  }
  return split;
}

}  // namespace morphbake::test
