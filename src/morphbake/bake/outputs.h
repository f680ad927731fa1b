#pragma once

#include "morphbake/bake/bake.h"
#include "morphbake/bake/shape_colours.h"
#include "morphbake/bake/solve_timeline.h"
#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/export/mesh_morph.h"
#include "morphbake/files/files.h"

namespace morphbake {

/// What all outputs of a recipe are made from; the stages' results, by reference.
struct SolvedRecipe {
  const Recipe& recipe;
  const SourceMesh& first;
  const MorphableMesh& mesh;
  const RegionFields& regions;
  const SolvedTimeline& timeline;
  const SmoothingGroups& groups;
  const ShapeColours& colours;
};

/// An output that waits to be committed.
struct StagedOutput {
  OutputReport report;
  std::filesystem::path file;  ///< the temporary one
  int node = 0;                ///< of the file: that shows the morph
};

/// Reduces, writes and measures one output.
///
/// @throws BakeError "export.normal-error" when a bound on normals is not kept and shall be
StagedOutput stage_output(const SolvedRecipe& solved, std::size_t index, const BakeOptions& options,
                          const Observer& observer, PendingOutputs& outputs);

}  // namespace morphbake
