#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "morphbake/correspondence/capped_surface.h"
#include "morphbake/correspondence/triangle_energy.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/closed_mesh.h"

namespace morphbake {

/// A surface on its way to the sphere: coarsened to a few vertices, then laid out while the
/// collapses are taken back one by one.
///
/// Invariant once lie_down was called: every triangle of `mesh` is counter-clockwise on the sphere;
/// boundary vertices have z = 0; the apex of a disk is the south pole.
struct SphereLayout {
  const CappedSurface* surface = nullptr;
  std::vector<Eigen::Vector3d> positions;  ///< #V, of area 1
  ClosedMesh mesh;
  std::vector<CollapseRecord> collapses;
  std::vector<Eigen::Vector3d> sphere;   ///< #V, unit length where the vertex lives
  std::vector<char> pinned;              ///< #V: may not move any more
  std::vector<Eigen::Vector3d> targets;  ///< #V or none: where landmarks are drawn to; 0: nowhere
  double pull = 0;                       ///< weight of the squared distance to the target
  double rest_scale = 1;                 ///< from areas of `positions` to areas of the sphere
};

SphereLayout make_layout(const CappedSurface& surface);

/// Whether a collapse is allowed besides what connectivity demands.
using CollapseFilter = std::function<bool(const ClosedMesh& mesh, int half_edge)>;

/// Collapses edges, those first that change the surface least, down to `count` vertices or until
/// nothing more can be collapsed. Landmarks go last; the boundary stays a boundary.
///
/// @throws Cancelled
/// @cost   O(n log n) collapses, each as dear as the valences around it
/// @see Garland and Heckbert 1997 (quadrics); Hoppe 1996 (record of collapses)
void coarsen(SphereLayout& layout, int count, const CollapseFilter& allowed,
             const Observer& observer = {});

/// Lays the coarsest level down: a regular tetrahedron, or a pyramid over the equator.
void lie_down(SphereLayout& layout);

/// Takes collapses back until `count` vertices live; each new vertex goes into the kernel of its
/// ring, and all are relaxed each time their number grew by 2/5.
///
/// @throws BakeError "correspondence.no-room" when a vertex finds no place (seen on poles of
///         thousands of neighbours); Cancelled
void refine(SphereLayout& layout, int count, const Observer& observer = {});

/// Moves vertices to less distortion, one by one, none so far that a triangle turns.
///
/// @throws Cancelled
void relax(SphereLayout& layout, int sweeps, const Observer& observer = {});

/// Energy of the star of `vertex` were it at `place`; infinite where a triangle would turn.
double star_energy(const SphereLayout& layout, int vertex, const Eigen::Vector3d& place);

}  // namespace morphbake
