#include "shapes/shapes.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace morphbake::test {
namespace {

constexpr double kPi = std::numbers::pi;

Triangles to_triangles(const std::vector<Eigen::Vector3i>& list) {
  Triangles triangles(static_cast<Eigen::Index>(list.size()), 3);
  for (std::size_t f = 0; f < list.size(); ++f)
    triangles.row(static_cast<Eigen::Index>(f)) = list[f];
  return triangles;
}

void add_quad(std::vector<Eigen::Vector3i>& list, int a, int b, int c, int d) {
  list.emplace_back(a, b, c);
  list.emplace_back(a, c, d);
}

}  // namespace

Mesh tetrahedron() {
  Mesh mesh{Positions(4, 3), Triangles(4, 3)};
  mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.triangles << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  return mesh;
}

Mesh sphere(int rings, int segments) {
  Mesh mesh{Positions((rings - 1) * segments + 2, 3), {}};
  std::vector<Eigen::Vector3i> list;
  const int north = (rings - 1) * segments, south = north + 1;
  for (int r = 0; r + 1 < rings; ++r) {
    const double polar = kPi * (r + 1) / rings;
    for (int s = 0; s < segments; ++s) {
      const double turn = 2 * kPi * s / segments;
      mesh.positions.row(r * segments + s) << std::sin(polar) * std::sin(turn), std::cos(polar),
          std::sin(polar) * std::cos(turn);
      const int next = (s + 1) % segments;
      if (r + 2 < rings) {
        add_quad(list, r * segments + s, (r + 1) * segments + s, (r + 1) * segments + next,
                 r * segments + next);
      }
      if (r == 0) list.emplace_back(north, s, next);
      if (r + 2 == rings) list.emplace_back(south, r * segments + next, r * segments + s);
    }
  }
  mesh.positions.row(north) << 0, 1, 0;
  mesh.positions.row(south) << 0, -1, 0;
  mesh.triangles = to_triangles(list);
  return mesh;
}

Mesh torus(int rings, int segments) {
  Mesh mesh{Positions(rings * segments, 3), {}};
  std::vector<Eigen::Vector3i> list;
  for (int r = 0; r < rings; ++r) {
    const double u = 2 * kPi * r / rings;
    for (int s = 0; s < segments; ++s) {
      const double v = 2 * kPi * s / segments;
      const double radius = 1 + 0.4 * std::cos(v);
      mesh.positions.row(r * segments + s) << radius * std::cos(u), 0.4 * std::sin(v),
          -radius * std::sin(u);
      const int next_r = (r + 1) % rings, next_s = (s + 1) % segments;
      add_quad(list, r * segments + s, next_r * segments + s, next_r * segments + next_s,
               r * segments + next_s);
    }
  }
  mesh.triangles = to_triangles(list);
  return mesh;
}

Mesh grid(int columns, int rows) {
  Mesh mesh{Positions(columns * rows, 3), {}};
  std::vector<Eigen::Vector3i> list;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      mesh.positions.row(r * columns + c) << c, r, 0;
      if (r + 1 == rows || c + 1 == columns) continue;
      const int corner = r * columns + c;
      add_quad(list, corner, corner + 1, corner + columns + 1, corner + columns);
    }
  }
  mesh.triangles = to_triangles(list);
  return mesh;
}

Mesh bar(int across) {
  constexpr double kWidth = 0.2;
  const int along = 5 * across;
  std::map<std::array<int, 3>, int> numbers;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> list;
  const auto vertex = [&](int i, int j, int k) {
    const auto [entry, is_new] = numbers.try_emplace({i, j, k}, static_cast<int>(points.size()));
    const double cells = across;
    if (is_new)
      points.emplace_back((i / cells - 0.5) * kWidth, j / (5 * cells), (k / cells - 0.5) * kWidth);
    return entry->second;
  };
  // Diagonals alternate, so that no way of twisting is along them.
  const auto add = [&](bool other_way, int a, int b, int c, int d) {
    if (other_way)
      add_quad(list, b, c, d, a);
    else
      add_quad(list, a, b, c, d);
  };
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < across; ++i) {
      const int n = across;
      const bool odd = (i + j) % 2 != 0;
      add(odd, vertex(i, j, n), vertex(i + 1, j, n), vertex(i + 1, j + 1, n), vertex(i, j + 1, n));
      add(odd, vertex(i + 1, j, 0), vertex(i, j, 0), vertex(i, j + 1, 0), vertex(i + 1, j + 1, 0));
      add(odd, vertex(n, j, i + 1), vertex(n, j, i), vertex(n, j + 1, i), vertex(n, j + 1, i + 1));
      add(odd, vertex(0, j, i), vertex(0, j, i + 1), vertex(0, j + 1, i + 1), vertex(0, j + 1, i));
    }
  }
  for (int i = 0; i < across; ++i) {
    for (int k = 0; k < across; ++k) {
      add_quad(list, vertex(i, 0, k), vertex(i + 1, 0, k), vertex(i + 1, 0, k + 1),
               vertex(i, 0, k + 1));
      add_quad(list, vertex(i, along, k + 1), vertex(i + 1, along, k + 1), vertex(i + 1, along, k),
               vertex(i, along, k));
    }
  }
  Mesh mesh{Positions(static_cast<Eigen::Index>(points.size()), 3), to_triangles(list)};
  for (std::size_t v = 0; v < points.size(); ++v) {
    mesh.positions.row(static_cast<Eigen::Index>(v)) = points[v].transpose();
  }
  return mesh;
}

Positions bent_and_twisted(const Positions& bar, double bend, double twist) {
  Positions moved(bar.rows(), 3);
  for (Eigen::Index v = 0; v < bar.rows(); ++v) {
    const double along = bar(v, 1), angle = twist * along;
    const double x = std::cos(angle) * bar(v, 0) + std::sin(angle) * bar(v, 2);
    const double z = std::cos(angle) * bar(v, 2) - std::sin(angle) * bar(v, 0);
    if (bend == 0) {
      moved.row(v) << x, along, z;
    } else {
      const double radius = 1 / bend;
      moved.row(v) << radius - (radius - x) * std::cos(bend * along),
          (radius - x) * std::sin(bend * along), z;
    }
  }
  return moved;
}

Mesh joined(const Mesh& a, const Mesh& b) {
  Mesh mesh{Positions(a.positions.rows() + b.positions.rows(), 3),
            Triangles(a.triangles.rows() + b.triangles.rows(), 3)};
  mesh.positions << a.positions, b.positions;
  mesh.triangles << a.triangles, b.triangles.array() + static_cast<int>(a.positions.rows());
  return mesh;
}

Positions bent(const Positions& positions, double amount, unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&] { return static_cast<double>(random()) / 4294967296.0 * 2 - 1; };
  Positions moved = positions;
  for (int wave = 0; wave < 4; ++wave) {
    const Eigen::Vector3d frequency(2 * number(), 2 * number(), 2 * number());
    const Eigen::RowVector3d direction(number(), number(), number());
    const double phase = kPi * number();
    for (Eigen::Index v = 0; v < positions.rows(); ++v) {
      moved.row(v) += amount * std::sin(positions.row(v).dot(frequency) + phase) * direction;
    }
  }
  return moved;
}

MorphableMesh morphable(const Triangles& triangles, const std::vector<Positions>& geometries) {
  MorphableMesh mesh;
  mesh.connectivity = {static_cast<int>(geometries.front().rows()), triangles};
  mesh.geometries = geometries;
  for (std::size_t s = 0; s < geometries.size(); ++s)
    mesh.names.emplace_back(1, static_cast<char>('a' + s));
  return mesh;
}

Eigen::MatrixXd random_weights(int sources, int vertices, unsigned seed) {
  std::mt19937 random(seed);
  Eigen::MatrixXd weights(sources, vertices);
  for (double& weight : weights.reshaped()) weight = static_cast<double>(random()) / 4294967296.0;
  return weights.array().rowwise() / weights.colwise().sum().array();
}

}  // namespace morphbake::test
