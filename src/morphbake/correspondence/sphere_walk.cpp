#include "morphbake/correspondence/sphere_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

constexpr int kCells = 16;      // along each edge of the cube
constexpr int kShortWalk = 48;  // steps after which a walk starts anew from the grid
constexpr int kLongWalk = 4000;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Cell of the cube's surface that a direction goes through.
int cell_of(const Vector3d& x) {
  int axis = 0;
  x.cwiseAbs().maxCoeff(&axis);
  const double largest = std::abs(x(axis));
  const auto along = [&](int k) {
    const double u = 0.5 * (x((axis + k) % 3) / largest + 1) * kCells;
    return std::clamp(static_cast<int>(u), 0, kCells - 1);
  };
  const int side = 2 * axis + (x(axis) < 0);
  return (side * kCells + along(1)) * kCells + along(2);
}

/// A direction through the middle of a cell.
Vector3d middle_of(int cell) {
  const int side = cell / (kCells * kCells), i = cell / kCells % kCells, j = cell % kCells;
  Vector3d x;
  x(side / 2) = side % 2 == 0 ? 1 : -1;
  x((side / 2 + 1) % 3) = 2 * (i + 0.5) / kCells - 1;
  x((side / 2 + 2) % 3) = 2 * (j + 0.5) / kCells - 1;
  return x.normalized();
}

std::vector<int> find_opposites(const Triangles& triangles) {
  const int* from = triangles.data();
  std::vector<std::array<int, 3>> edges;
  edges.reserve(index(static_cast<int>(triangles.size())));
  for (int h = 0; h < static_cast<int>(triangles.size()); ++h) {
    const int a = from[h], b = from[h % 3 == 2 ? h - 2 : h + 1];
    edges.push_back({std::min(a, b), std::max(a, b), h});
  }
  std::sort(edges.begin(), edges.end());
  std::vector<int> opposite(edges.size(), -1);
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    if (edges[e][0] != edges[e + 1][0] || edges[e][1] != edges[e + 1][1]) continue;
    opposite[index(edges[e][2])] = edges[e + 1][2];
    opposite[index(edges[e + 1][2])] = edges[e][2];
  }
  return opposite;
}

}  // namespace

SphereAtlas::SphereAtlas(const SphericalMap& spherical) : map(&spherical) {
  const Triangles& triangles = map->surface.triangles;
  const Positions& scene = map->surface.positions;
  double area = 0;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const Vector3d a = scene.row(triangles(f, 0)), b = scene.row(triangles(f, 1)),
                   c = scene.row(triangles(f, 2));
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  scale = area > 0 ? 1 / std::sqrt(area) : 1;
  centre = scene.colwise().mean();
  diagonal = scale * bounding_diagonal(scene);
  triangle_of_vertex.assign(index(static_cast<int>(scene.rows())), 0);
  for (Eigen::Index v = 0; v < scene.rows(); ++v) {
    positions.emplace_back(scale * (scene.row(v).transpose() - centre));
    sphere.emplace_back(map->sphere.row(v));
  }
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const Vector3d &a = positions[index(triangles(f, 0))], &b = positions[index(triangles(f, 1))],
                   &c = positions[index(triangles(f, 2))];
    normals.push_back((b - a).cross(c - a).normalized());
    for (int k = 0; k < 3; ++k) triangle_of_vertex[index(triangles(f, k))] = static_cast<int>(f);
  }
  opposite = find_opposites(triangles);
  fill_grid();
}

void SphereAtlas::fill_grid() {
  grid_.assign(index(6 * kCells * kCells), -1);
  for (int f = 0; f < map->surface.triangles.rows(); ++f) {
    const Vector3d middle = corner(3 * f) + corner(3 * f + 1) + corner(3 * f + 2);
    grid_[index(cell_of(middle))] = f;
  }
  // Empty cells: walk there from the last filled one.
  const auto place = [&](int h) -> const Vector3d& { return corner(h); };
  const auto across = [&](int h) { return opposite[index(h)]; };
  int last = 0;
  for (int cell = 0; cell < 6 * kCells * kCells; ++cell) {
    int& entry = grid_[index(cell)];
    if (entry < 0) {
      const int found = walk_to(middle_of(cell), last, kLongWalk, place, across);
      entry = found < 0 ? last : found;
    }
    last = entry;
  }
}

int SphereAtlas::locate(const Vector3d& x, int start) const {
  const auto place = [&](int h) -> const Vector3d& { return corner(h); };
  const auto across = [&](int h) { return opposite[index(h)]; };
  // A walk over more than a third of the sphere could run to the antipode.
  if (x.dot(corner(3 * start)) > 0.5) {
    const int found = walk_to(x, start, kShortWalk, place, across);
    if (found >= 0) return found;
  }
  const int found = walk_to(x, grid_[index(cell_of(x))], kLongWalk, place, across);
  if (found >= 0) return found;
  const auto all = [](int) { return true; };
  return search_triangle(x, static_cast<int>(normals.size()), all, place);
}

Vector3d SphereAtlas::weights_at(const Vector3d& x, int triangle) const {
  const Vector3d weights =
      central_weights(x, corner(3 * triangle), corner(3 * triangle + 1), corner(3 * triangle + 2))
          .cwiseMax(0);
  const double sum = weights.sum();
  return sum > 0 ? Vector3d(weights / sum) : Vector3d::Constant(1.0 / 3);
}

Vector3d SphereAtlas::position(int triangle, const Vector3d& weights) const {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) sum += weights(k) * positions[index(from(3 * triangle + k))];
  return sum;
}

Mesh SphereAtlas::mesh() const {
  Mesh mesh{Positions(static_cast<Eigen::Index>(positions.size()), 3), map->surface.triangles};
  for (std::size_t v = 0; v < positions.size(); ++v) {
    mesh.positions.row(static_cast<Eigen::Index>(v)) = positions[v];
  }
  return mesh;
}

Eigen::Matrix3d SphereAtlas::jacobian(const Vector3d& x, int triangle) const {
  const Vector3d &a = corner(3 * triangle), &b = corner(3 * triangle + 1),
                 &c = corner(3 * triangle + 2);
  const Vector3d weights = central_weights(x, a, b, c);
  const double sum = weights.sum();
  const Vector3d here = position(triangle, weights / sum);
  const std::array<Vector3d, 3> gradients{b.cross(c - b), c.cross(a - c), a.cross(b - a)};
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    jacobian += (positions[index(from(3 * triangle + k))] - here) * gradients[index(k)].transpose();
  }
  return jacobian / sum;
}

}  // namespace morphbake
