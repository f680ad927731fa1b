#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/mesh/surface_edges.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// The surface of a file's mesh, welded and mended as that of a source, to be followed in a motion.
struct FollowedSurface {
  Triangles triangles;           ///< #F by 3
  SurfaceEdges edges;            ///< each once, also along seams
  std::vector<int> vertices_at;  ///< #R, render vertex -> vertex, -1 where no triangle uses it
  std::vector<int> render_of;    ///< #V, vertex -> its first render vertex
};

FollowedSurface follow_surface(const SourceMesh& source);

/// What happens to a surface, one number a time. "Expected" is the linear mix, in time, of what it
/// is in the first and the last frame of its animation; before and after these, the frame itself.
struct MotionMeasures {
  std::vector<double> volume;         ///< scene units cubed, negative inside out; none when open
  std::vector<double> volume_change;  ///< (volume - expected) / first; none when open
  std::vector<double> area;           ///< scene units squared
  std::vector<double> area_change;    ///< (area - expected) / first
  std::vector<double> edge_length_change;  ///< rms over edges of length / expected - 1
  std::vector<double>
      bend_change;          ///< rms over edges of angle - expected, degrees: see bend_angles
  double largest_tear = 0;  ///< scene units between vertices of the file that are one at rest
  double tear_time = 0;     ///< seconds
};

/// Measures a motion at `times`, seconds.
///
/// NaN stands for what there is not: a change of nothing, angles of a surface without inner edges.
/// Edges whose expected length is 0 do not count, nor angles beside triangles without area.
/// @param mesh     of the same file and node as the surface
/// @param threads  0: all cores; never changes a bit
/// @throws BakeError "preview.not-finite" without a file; Cancelled
/// @cost   O(#targets #R + #E) a time; eight times are in memory at once
MotionMeasures measure_motion(const AnimatedMesh& mesh, const FollowedSurface& surface,
                              const std::vector<double>& times, int threads,
                              const Observer& observer);

/// The number that is furthest from 0, and where it stands; -1 when all are NaN or there is none.
int furthest_from_zero(const std::vector<double>& values);

}  // namespace morphbake
