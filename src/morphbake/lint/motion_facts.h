#pragma once

// Internal to lint/: what the animations of a mesh do to it.

#include "morphbake/gltf/mesh_survey.h"
#include "morphbake/lint/lint.h"

namespace morphbake {

/// Finds the most targets that are active at one time, between keys too.
void find_active(const MeshSurvey& survey, LintedMesh& facts);

/// Finds the bounds at rest and over all animations.
///
/// Between LINEAR and STEP keys no vertex leaves the box of the keys; CUBICSPLINE curves are looked
/// at eight times a key. Beyond some seconds' work keys are left out evenly.
void find_bounds(const MeshSurvey& survey, LintedMesh& facts, const Observer& observer);

}  // namespace morphbake
