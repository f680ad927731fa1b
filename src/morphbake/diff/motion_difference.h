#pragma once

#include <Eigen/Core>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/diff/instants.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/target_rows.h"

namespace morphbake {

/// A mesh and its targets, of which its own primitives need have none.
struct MorphingMesh {
  const AnimatedMesh& mesh;
  const TargetRows& targets;
};

/// Two meshes that have primitives of as many vertices.
struct MeshPair {
  MorphingMesh a;
  MorphingMesh b;
  std::vector<std::size_t> primitives;  ///< those that both have and that have as many vertices
};

/// Where and when a difference is largest.
struct LargestDifference {
  double value = 0;
  double time = 0;      ///< seconds
  int primitive = -1;   ///< -1: nowhere, all is the same
  int vertex = -1;      ///< of the primitive
  double sampling = 0;  ///< scene units, of positions: what the sampling explained besides `value`
};

/// The largest differences of each vertex over time, primitive after primitive of MeshPair.
struct VertexDifferences {
  Eigen::VectorXd distance;      ///< #R, scene units
  Eigen::VectorXd normal_angle;  ///< #R, degrees
};

/// How far two motions are apart.
struct MotionDifference {
  std::size_t instants = 0;
  LargestDifference position;  ///< scene units
  LargestDifference normal;    ///< degrees; nowhere where a primitive of either has no normals
};

/// What is done besides comparing at every instant.
struct MotionOptions {
  /// Whether what a file that is sampled cannot know between its frames is taken off: half of how
  /// far the vertex is off the straight line through three neighbouring frames. A smooth motion
  /// leaves its chords by an eighth of that, one with a corner by half.
  bool allows_sampling = true;
  int threads = 0;  ///< 0: all cores; never changes a bit
};

/// Compares two motions at all instants of their curves (common_instants), in scene space.
///
/// @param vertices  receives the larger of what it has and what is found here
/// @throws Cancelled
/// @cost   O(#instants sum of active targets #R); memory for a thousand vertices a thread, with all
///         of their targets, and for the weights of all instants
MotionDifference compare_motions(const MeshPair& meshes, const CurvePair& curves,
                                 const MotionOptions& options, VertexDifferences& vertices,
                                 const Observer& observer);

/// No differences yet.
VertexDifferences no_differences(const MeshPair& meshes);

}  // namespace morphbake
