#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "morphbake/correspondence/spherical_map.h"

namespace morphbake {

/// Walks over a triangulation of the sphere towards `x`, from triangle to triangle.
///
/// The edges of a triangle are tried in an order that a fixed sequence shuffles: without that a
/// walk may run in circles.
/// @param corner    corner(h): place of the corner where half-edge h begins
/// @param opposite  opposite(h): the half-edge across, -1 at a border, where the walk stays
/// @return          the triangle, or -1 after `limit` steps
template <typename Corner, typename Opposite>
int walk_to(const Eigen::Vector3d& x, int triangle, int limit, const Corner& corner,
            const Opposite& opposite) {
  std::uint32_t shuffle = 12345;
  for (int step = 0; step < limit; ++step) {
    shuffle = shuffle * 1664525u + 1013904223u;
    const int first = static_cast<int>((shuffle >> 16) % 3);
    bool is_inside = true;
    for (int i = 0; i < 3 && is_inside; ++i) {
      const int k = (first + i) % 3;
      const Eigen::Vector3d &a = corner(3 * triangle + k), &b = corner(3 * triangle + (k + 1) % 3);
      if (!((a - x).cross(b - x).dot(x) < 0)) continue;
      const int across = opposite(3 * triangle + k);
      if (across < 0) continue;
      triangle = across / 3;
      is_inside = false;
    }
    if (is_inside) return triangle;
  }
  return -1;
}

/// Barycentric coordinates of the central projection of `x` onto the triangle; not clamped.
inline Eigen::Vector3d central_weights(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d xa = a - x, xb = b - x, xc = c - x;
  return {xb.cross(xc).dot(x), xc.cross(xa).dot(x), xa.cross(xb).dot(x)};
}

/// The triangle at `x`, or the one that misses it least, by a look at all: where a walk got lost.
///
/// @param is_there  is_there(triangle): whether the slot has one
/// @param corner    as that of walk_to
template <typename IsThere, typename Corner>
int search_triangle(const Eigen::Vector3d& x, int slots, const IsThere& is_there,
                    const Corner& corner) {
  int best = -1;
  double best_weight = 0;
  for (int f = 0; f < slots; ++f) {
    if (!is_there(f)) continue;
    const Eigen::Vector3d &a = corner(3 * f), &b = corner(3 * f + 1), &c = corner(3 * f + 2);
    // One corner at least lies before x, or the triangle is on the other side.
    if (x.dot(a) < 0 && x.dot(b) < 0 && x.dot(c) < 0) continue;
    const double weight = central_weights(x, a, b, c).minCoeff();
    if (best >= 0 && weight <= best_weight) continue;
    best_weight = weight;
    best = f;
  }
  return best;
}

/// A mapped surface on which places are looked up by their place on the sphere.
///
/// Positions are the surface's moved to its centre and scaled to area 1.
struct SphereAtlas {
  explicit SphereAtlas(const SphericalMap& map);

  const Eigen::Vector3d& corner(int h) const { return sphere[static_cast<std::size_t>(from(h))]; }

  int from(int h) const { return map->surface.triangles.data()[h]; }

  /// The triangle at a place of the sphere; the nearest one beyond the border of a disk.
  /// @param start  a triangle near by; the nearer, the faster
  int locate(const Eigen::Vector3d& x, int start) const;

  /// Barycentric coordinates in `triangle`, all >= 0, sum 1.
  Eigen::Vector3d weights_at(const Eigen::Vector3d& x, int triangle) const;

  Eigen::Vector3d position(int triangle, const Eigen::Vector3d& weights) const;

  /// The surface in the atlas's units.
  Mesh mesh() const;

  /// Derivative of the position by the place on the sphere, within a triangle.
  Eigen::Matrix3d jacobian(const Eigen::Vector3d& x, int triangle) const;

  const SphericalMap* map;
  std::vector<Eigen::Vector3d> sphere;     ///< #V
  std::vector<Eigen::Vector3d> positions;  ///< #V
  std::vector<Eigen::Vector3d> normals;    ///< #F, unit length; 0 of triangles without area
  std::vector<int> opposite;               ///< 3 #F, -1 at a border
  std::vector<int> triangle_of_vertex;     ///< #V: one that has it
  double diagonal = 1;                     ///< of the bounding box of `positions`
  double scale = 1;                        ///< position = scale * (scene position - centre)
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();

 private:
  void fill_grid();

  std::vector<int> grid_;  ///< a triangle near each cell of a cube around the sphere
};

}  // namespace morphbake
