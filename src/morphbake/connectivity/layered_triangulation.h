#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/correspondence/sphere_walk.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/closed_mesh.h"

namespace morphbake {

/// A triangulation as it lies on one source.
struct Layer {
  SphereAtlas atlas;
  std::vector<Eigen::Vector3d> sphere;  ///< #V: place on the sphere
  std::vector<Eigen::Vector3d> lifted;  ///< #V: place on the source, in the atlas's units
  std::vector<int> triangle;            ///< #V: the atlas's triangle there
};

/// One triangulation that lies on several sources through the sphere that they share.
///
/// Invariant: every triangle is counter-clockwise in every layer (is_positive); vertices of the
/// boundary have z = 0 in every layer; fixed vertices never move or go.
struct LayeredTriangulation {
  ClosedMesh mesh;
  std::vector<Layer> layers;
  std::vector<char> is_fixed;     ///< #V: landmarks and the apex
  std::vector<char> on_boundary;  ///< #V
  int apex = -1;                  ///< of disks
  std::vector<int> landmarks;
  std::unordered_set<std::uint64_t> hard_edges;  ///< keys of edge_key
  /// Whom each pass over the triangulation asks whether to stop; passes throw Cancelled. It lies
  /// here since all of them would take it beside the triangulation.
  Observer observer = {};

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  bool is_cap(int f) const {
    return apex >= 0 && (mesh.from(3 * f) == apex || mesh.from(3 * f + 1) == apex ||
                         mesh.from(3 * f + 2) == apex);
  }

  bool is_boundary_edge(int h) const {
    return is_cap(ClosedMesh::triangle_of(h)) != is_cap(ClosedMesh::triangle_of(mesh.opposite(h)));
  }

  bool is_hard(int h) const { return hard_edges.count(edge_key(mesh.from(h), mesh.to(h))) > 0; }

  bool is_on_hard_edge(int v) const {
    if (hard_edges.empty()) return false;
    bool is_hard_here = false;
    mesh.around(v, [&](int h) { is_hard_here |= is_hard(h); });
    return is_hard_here;
  }

  static std::uint64_t edge_key(int a, int b) {
    const auto low = static_cast<std::uint64_t>(a < b ? a : b);
    return low << 32 | static_cast<std::uint64_t>(a < b ? b : a);
  }

  /// Vertices without the apex.
  int vertex_count() const { return mesh.vertex_count() - (apex >= 0); }
};

/// Whether the triangle is counter-clockwise in all layers.
bool is_positive_everywhere(const LayeredTriangulation& t, int a, int b, int c);

/// Sets a vertex's place in one layer, from its place on the sphere.
void lift(Layer& layer, int vertex, const Eigen::Vector3d& place, int near_triangle);

/// Puts a vertex exactly, not to rounding, where one of the atlas's lies.
void lift_onto(Layer& layer, int vertex, int source_vertex);

/// (b - a) x (c - a) of a triangle on one source.
inline Eigen::Vector3d area_normal(const Layer& layer, int a, int b, int c) {
  const auto at = [&](int v) -> const Eigen::Vector3d& {
    return layer.lifted[static_cast<std::size_t>(v)];
  };
  return (at(b) - at(a)).cross(at(c) - at(a));
}

/// The atlas's triangle below the middle of a triangle.
int triangle_below(const Layer& layer, int a, int b, int c);

/// Unit normal of the source below the middle of a triangle.
Eigen::Vector3d normal_below(const Layer& layer, int a, int b, int c);

/// Distance of the source from the middle of the chord a - b, seen along `direction` (with length
/// 0: in full), as a fraction of the diagonal.
double middle_deviation(const Layer& layer, int a, int b, const Eigen::Vector3d& direction);

/// The slots of all triangles but caps.
std::vector<int> surface_triangles(const LayeredTriangulation& t);

/// Triangles as they lie on one source, in the atlas's units; vertices keep their slots.
Mesh lifted_mesh(const LayeredTriangulation& t, const Layer& layer, const std::vector<int>& slots);

/// Where a vertex would lie in every layer.
using Places = std::vector<Eigen::Vector3d>;

/// Places at one barycentric place of a triangle in every layer.
Places places_in_triangle(const LayeredTriangulation& t, int f, const Eigen::Vector3d& weights);

/// The triangle of `t` over a place on the sphere in one layer.
///
/// @param start  a triangle near by; the nearer, the faster; -1: unknown
int triangle_over(const LayeredTriangulation& t, const Layer& layer, const Eigen::Vector3d& x,
                  int start);

/// Splits an edge.
///
/// @param places  one a layer
/// @return        the new vertex; -1 when a triangle would turn, and then nothing has changed
int split_edge_at(LayeredTriangulation& t, int h, const Places& places);

/// Puts a vertex into a triangle; as split_edge_at.
int split_triangle_at(LayeredTriangulation& t, int f, const Places& places);

/// Places at one fraction of an edge in every layer.
Places places_on_edge(const LayeredTriangulation& t, int h, double fraction);

/// Whether the edge can be turned: no cap, no hard edge, no double edge, no turned triangle.
bool can_flip(const LayeredTriangulation& t, int h);

/// Whether from(h) can go into to(h): it is free, stays on what it lies on, no triangle turns.
bool can_collapse(const LayeredTriangulation& t, int h);

/// Collapses an edge that can be collapsed.
void collapse(LayeredTriangulation& t, int h);

/// The triangulation by itself: vertices in the order of their slots, triangles in that of
/// surface_triangles.
SharedTriangulation shared_triangulation(const LayeredTriangulation& t);

/// The coarsest triangulation: that of the first source, simplified as far as the maps allow.
///
/// @param count     vertices to stop at
/// @param observer  whom this and all passes over the triangulation ask whether to stop
LayeredTriangulation coarse_triangulation(const std::vector<SphericalMap>& maps, int count,
                                          const Observer& observer = {});

}  // namespace morphbake
