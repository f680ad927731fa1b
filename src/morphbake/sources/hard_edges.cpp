#include "morphbake/sources/hard_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace morphbake {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kBrokenShading = 5 * kDegree;
constexpr double kFold = 40 * kDegree;

/// A triangle's side from its vertices a < b, with its corners at both.
struct Side {
  int a = 0;
  int b = 0;
  int corner_at_a = 0;  ///< corner of the surface
  int corner_at_b = 0;
};

/// Sides of the triangles, those of one edge after one another.
std::vector<Side> sorted_sides(const Triangles& triangles) {
  std::vector<Side> sides;
  sides.reserve(static_cast<std::size_t>(triangles.size()));
  for (int f = 0; f < triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const int v = triangles(f, k), w = triangles(f, next);
      sides.push_back(v < w ? Side{v, w, 3 * f + k, 3 * f + next}
                            : Side{w, v, 3 * f + next, 3 * f + k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::array{x.a, x.b, x.corner_at_a} < std::array{y.a, y.b, y.corner_at_a};
  });
  return sides;
}

/// 0 where one of them has no direction.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Vector3d face_normal(const Mesh& mesh, int triangle) {
  const auto corner = [&](int k) -> Eigen::Vector3d {
    return mesh.positions.row(mesh.triangles(triangle, k));
  };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

/// What the comparison of shading across an edge needs.
struct Shading {
  const CornerSurface& surface;
  std::vector<int> render;  ///< of each corner of the surface
  Float3s normals;          ///< of each render vertex, or no rows

  /// A triangle that the surface turned has its normals on the other side than its neighbour.
  double angle(int corner, int other) const {
    const auto normal = [&](int c) -> Eigen::Vector3d {
      return normals.row(render[static_cast<std::size_t>(c)]).transpose().cast<double>();
    };
    const double seen = angle_between(normal(corner), normal(other));
    const bool are_alike =
        runs_as_in_file(surface, corner / 3) == runs_as_in_file(surface, other / 3);
    return are_alike ? seen : std::min(seen, std::numbers::pi - seen);
  }

  bool is_broken(const Side& x, const Side& y) const {
    return angle(x.corner_at_a, y.corner_at_a) > kBrokenShading &&
           angle(x.corner_at_b, y.corner_at_b) > kBrokenShading;
  }
};

}  // namespace

std::vector<Eigen::Vector2i> find_hard_edges(const SourceMesh& source, const CornerSurface& surface,
                                             const Mesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh.triangles);
  const Shading shading{surface, render_corners(source, surface), file_normals(source)};
  std::vector<Eigen::Vector2i> broken, broken_and_folded;
  std::size_t inner_edges = 0;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &x = sides[i], &y = sides[i + 1];
    if (x.a != y.a || x.b != y.b) continue;
    ++inner_edges;
    if (shading.normals.rows() > 0 && !shading.is_broken(x, y)) continue;
    broken.emplace_back(x.a, x.b);
    const double fold =
        angle_between(face_normal(mesh, x.corner_at_a / 3), face_normal(mesh, y.corner_at_a / 3));
    if (fold > kFold) broken_and_folded.emplace_back(x.a, x.b);
  }
  const bool is_flat = 2 * broken.size() > inner_edges;
  return is_flat ? broken_and_folded : broken;
}

}  // namespace morphbake
