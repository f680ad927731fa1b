#pragma once

#include "morphbake/bake/shape_colours.h"
#include "morphbake/bake/solve_timeline.h"
#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/export/render_normals.h"

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

}  // namespace morphbake
