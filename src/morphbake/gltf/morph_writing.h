#pragma once

// Internal to gltf/: a morph on its way into a copy of its source, and the steps of
// write_morph_glb.

#include <vector>

#include "morphbake/gltf/document.h"
#include "morphbake/gltf/draft_references.h"
#include "morphbake/gltf/write_morph.h"

namespace morphbake {

/// What is written, and from what.
struct MorphWriting {
  const GltfDocument& document;
  const MeshMorph& morph;
  std::size_t own_targets = 0;  ///< of the mesh as the file has it
  int mesh = 0;                 ///< of the draft: morph.mesh, or a copy of it
  GlbDraft draft;
  References references;
};

/// The mesh of the draft that gets the morph.
Json& mesh_of(MorphWriting& writing);

/// Weights of the mesh's own targets at rest.
Eigen::VectorXd own_weights(const MorphWriting& writing);

/// Weights of the new targets where nothing moves them.
std::vector<float> first_weights(const MeshMorph& morph);

/// A name of which there is none yet: `name`, or with a number behind it. At most 63 bytes, as
/// Blender cuts them.
std::string free_name(const std::string& name, const std::set<std::string>& taken);

/// Gives the node a mesh of its own where another node poses the same mesh by a skin: what is
/// posed once and for all would be posed there again.
void separate_posed_mesh(MorphWriting& writing);

/// Takes the skin from the node, and from its mesh what hangs on joints.
///
/// @throws BakeError "gltf.singular-transform" when the mesh cannot be seen without
void drop_skin(MorphWriting& writing);

/// Gives the mesh a base shape that shows the morph's when the mesh's own targets have their
/// weights at rest.
void place_base(MorphWriting& writing);

/// Gives the mesh the morph's colours, where it has some.
void place_colours(MorphWriting& writing);

/// Appends the morph's targets with their names and weights.
void place_targets(MorphWriting& writing);

/// Gives animations of the mesh's weights numbers for the morph's targets.
///
/// @throws BakeError "gltf.too-large"; those of reading for animations that cannot be read
void extend_animations(MorphWriting& writing);

}  // namespace morphbake
