#pragma once

#include <functional>
#include <string>
#include <vector>

#include "morphbake/basis/morph_basis.h"
#include "morphbake/export/render_normals.h"
#include "morphbake/gltf/write_morph.h"

namespace morphbake {

/// The motion that a file is to show: exact positions of K at any moment.
struct ReferenceMotion {
  std::vector<double> frame_times;                     ///< seconds, rising
  std::function<Positions(double time)> positions_at;  ///< #V by 3, scene space
  /// #V by 3, linear RGB; nothing where colours do not change.
  std::function<Positions(double time)> colours_at = {};
  Positions first_colours = {};  ///< at the first frame of the timeline
  std::string name = {};         ///< of the clip that it is
};

/// The motion of a separable timeline, exact at any time.
///
/// @param shapes, separable, timeline  must outlive the motion
ReferenceMotion continuous_motion(const SolvedShapes& shapes, const SeparableTimeline& separable,
                                  const Timeline& timeline);

/// The motion that goes straight from frame to frame.
///
/// @param frames  must outlive the motion
ReferenceMotion stepped_motion(const FrameSource& frames);

/// The part of a motion that a clip shows, from 0 on.
///
/// @param motion  must outlive it
ReferenceMotion motion_of(const ReferenceMotion& motion, const Clip& clip);

/// Brings a basis from K and scene space to the primitives of the first source's file.
///
/// Normal targets are the least-squares fit of the deformed normals over all frames to the weights:
/// normals are not linear in them. Vertices that do not move keep the file's own bytes.
/// @param motions  one a clip of the basis
MeshMorph make_mesh_morph(const SourceMesh& first, const MorphableMesh& mesh,
                          const MorphBasis& basis, const SmoothingGroups& groups,
                          const std::vector<ReferenceMotion>& motions);

/// A plain mesh at `positions`, without targets.
///
/// @param colours  #V by 3, linear RGB, or no rows where the file's stand
MeshMorph make_still(const SourceMesh& first, const MorphableMesh& mesh,
                     const SmoothingGroups& groups, const Positions& positions,
                     const Positions& colours);

/// How far what is written is from the motion, over all frames and the moments half-way between
/// them.
struct MorphError {
  double distance = 0;         ///< scene units, largest
  double distance_time = 0;    ///< seconds, where that is
  int distance_vertex = 0;     ///< vertex of the first source's file where it is
  double normal_angle = 0;     ///< degrees, largest
  double normal_angle_99 = 0;  ///< degrees, of 99 in 100 vertices and moments
  double normal_time = 0;      ///< seconds, where the largest is
  int normal_vertex = 0;       ///< vertex of the first source's file where it is
};

/// @param written  as the bytes that were written read: its vertices are those of the first source
MorphError measure_mesh_morph(const MorphableMesh& mesh, const AnimatedMesh& written,
                              const SmoothingGroups& groups, const ReferenceMotion& motion);

}  // namespace morphbake
