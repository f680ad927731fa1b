#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// A source's surface laid bijectively on the unit sphere (closed, genus 0) or on its upper half
/// (a disk, its boundary on the equator).
///
/// The surface is the source's, finer only where it had to be: its landmarks are vertices of it,
/// and no inner edge of a disk joins two boundary vertices.
struct SphericalMap {
  Mesh surface;                             ///< scene space
  std::vector<SurfacePoint> on_source;      ///< #V: where each vertex lies on SourceSurface::mesh
  std::vector<int> source_triangle;         ///< #F: triangle of SourceSurface::mesh it lies in
  Triangles source_triangles;               ///< SourceSurface::mesh.triangles
  Positions sphere;                         ///< #V by 3, unit length; z = 0 on the boundary
  std::vector<char> on_boundary;            ///< #V
  std::vector<int> landmarks;               ///< vertex of each landmark, in the sources' order
  std::vector<Eigen::Vector2i> hard_edges;  ///< a < b
};

/// The point of a source's mesh at barycentric `weights` in a triangle of its map's surface.
SurfacePoint point_on_source(const SphericalMap& map, int triangle, const Eigen::Vector3d& weights);

/// Lays all sources on one sphere, on which equal landmarks coincide exactly.
///
/// Every map is checked with exact predicates: no triangle is turned, the sphere is covered once,
/// landmarks coincide, boundaries lie on the equator.
/// @param surfaces  two or more, each in one piece, all closed of genus 0 or all disks, with equal
///                  landmark names in equal order
/// @throws BakeError "correspondence...."; Cancelled
/// @cost   linear in the vertices of all sources, about 20 us a vertex; one task a source
/// @see    Hoppe 1996 (progressive meshes); Praun and Hoppe 2003; Schmidt et al. 2023
std::vector<SphericalMap> map_to_sphere(const std::vector<SourceSurface>& surfaces,
                                        const Observer& observer);

}  // namespace morphbake
