#pragma once

#include <vector>

#include "morphbake/diff/file_difference.h"
#include "morphbake/gltf/gltf_file.h"
#include "morphbake/gltf/mesh_facts.h"

namespace morphbake {

/// A mesh of one file.
struct OpenMesh {
  GltfFile file;
  ShownMesh at;
  AnimatedMesh mesh;  ///< without the rows of its targets
  TargetRows targets;
};

/// The primitives that both have and that have as many vertices.
std::vector<std::size_t> comparable_primitives(const OpenMesh& a, const OpenMesh& b);

/// What is not the same in two meshes besides their motion: primitives, vertices, triangles,
/// attributes, materials, textures, names of targets, bounds.
///
/// @throws BakeError "gltf.accessor", "gltf.not-finite"
std::vector<Finding> mesh_findings(const OpenMesh& a, const OpenMesh& b,
                                   const DiffOptions& options);

}  // namespace morphbake
