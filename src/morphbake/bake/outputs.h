#pragma once

#include "morphbake/bake/bake.h"
#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/export/mesh_morph.h"
#include "morphbake/files/files.h"

namespace morphbake {

/// What all outputs of a recipe are made from; the stages' results, by reference.
struct SolvedRecipe {
  const Recipe& recipe;
  const SourceMesh& first;
  const MorphableMesh& mesh;
  const std::vector<Eigen::VectorXd>& regions;
  const SeparableTimeline& separable;
  const LaplacianSystem& system;
  const TranslationGauge& gauge;
  const SolvedShapes& shapes;
  const SmoothingGroups& groups;
};

/// Reduces, writes and measures one output.
///
/// @return  its report; `staged` is the temporary file
OutputReport stage_output(const SolvedRecipe& solved, std::size_t index, const BakeOptions& options,
                          const Observer& observer, PendingOutputs& outputs,
                          std::filesystem::path& staged);

}  // namespace morphbake
