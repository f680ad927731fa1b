// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "models.h"

namespace shapes {
namespace {

using Cell = std::array<int, 3>;

constexpr Cell cells{12, 56, 12};
constexpr double pitch = 0.02;     // metres a cell
constexpr double rounding = 0.05;  // metres: radius of the bar's edges
constexpr double length = cells[1] * pitch;

/// Grid point of the box, pulled onto the box with rounded edges that fits inside it.
Vector rounded(const Cell& at) {
  const Vector half = pitch / 2 * Vector(cells[0], cells[1], cells[2]);
  const Vector p = pitch * Vector(at[0], at[1], at[2]) - half;
  const Vector core = p.cwiseMax(-half.array().matrix() + Vector::Constant(rounding))
                          .cwiseMin(half - Vector::Constant(rounding));
  return core + rounding * (p - core).normalized() + Vector(0, half.y(), 0);
}

/// The six sides of a box of cells, each cell two triangles, corners shared between sides.
class BoxSurface {
 public:
  BoxSurface() {
    for (int axis = 0; axis < 3; ++axis)
      for (const bool far_side : {false, true}) add_side(axis, far_side);
  }

  const std::vector<Cell>& points() const { return points_; }

  const std::vector<Eigen::RowVector3i>& triangles() const { return triangles_; }

 private:
  void add_side(int axis, bool far_side) {
    const auto a = static_cast<std::size_t>(axis);
    const std::size_t b = (a + 1) % 3;
    const std::size_t c = (a + 2) % 3;
    Cell at{};
    at[a] = far_side ? cells[a] : 0;
    const auto corner = [&](int u, int v) {
      at[b] = u;
      at[c] = v;
      return index(at);
    };
    for (int u = 0; u < cells[b]; ++u)
      for (int v = 0; v < cells[c]; ++v) {
        const int quad[] = {corner(u, v), corner(u + 1, v), corner(u + 1, v + 1), corner(u, v + 1)};
        const int second = far_side ? 1 : 3;
        triangles_.emplace_back(quad[0], quad[second], quad[2]);
        triangles_.emplace_back(quad[0], quad[2], quad[4 - second]);
      }
  }

  int index(const Cell& at) {
    const auto [entry, is_new] = index_.try_emplace(at, static_cast<int>(points_.size()));
    if (is_new) points_.push_back(at);
    return entry->second;
  }

  std::map<Cell, int> index_;
  std::vector<Cell> points_;
  std::vector<Eigen::RowVector3i> triangles_;
};

/// Turned about the bar's axis, then bent towards +Z.
Vector bent_and_twisted(const Vector& p) {
  constexpr double bend = 120 * std::numbers::pi / 180;
  constexpr double twist = 270 * std::numbers::pi / 180;
  const double share = p.y() / length;
  const double turn = twist * share;
  const double x = std::cos(turn) * p.x() + std::sin(turn) * p.z();
  const double z = -std::sin(turn) * p.x() + std::cos(turn) * p.z();
  const double angle = bend * share;
  const double radius = length / bend - z;
  return {x, radius * std::sin(angle), length / bend - radius * std::cos(angle)};
}

/// Two colours of sides that change along the bar: bend and twist can be read off.
Vector bar_color(const Vector& p) {
  const double share = p.y() / length;
  const Vector warm = srgb(0xf08a4b) + share * (srgb(0xd6455f) - srgb(0xf08a4b));
  const Vector cool = srgb(0x3f8fb5) + share * (srgb(0x5a4fa3) - srgb(0x3f8fb5));
  return std::abs(p.x()) > std::abs(p.z()) ? warm : cool;
}

}  // namespace

std::vector<NamedMesh> bars() {
  const BoxSurface box;
  Mesh straight;
  const auto vertices = static_cast<Eigen::Index>(box.points().size());
  straight.positions.resize(vertices, 3);
  straight.colors.resize(vertices, 3);
  straight.triangles.resize(static_cast<Eigen::Index>(box.triangles().size()), 3);
  Mesh bent = straight;
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const Vector p = rounded(box.points()[static_cast<std::size_t>(v)]);
    straight.positions.row(v) = p.transpose();
    bent.positions.row(v) = bent_and_twisted(p).transpose();
    straight.colors.row(v) = bar_color(p).transpose();
  }
  for (Eigen::Index f = 0; f < straight.triangles.rows(); ++f)
    straight.triangles.row(f) = box.triangles()[static_cast<std::size_t>(f)];
  bent.colors = straight.colors;
  bent.triangles = straight.triangles;
  round_to_float(straight.positions);
  round_to_float(bent.positions);
  return {{"bar_straight", straight}, {"bar_bent_twisted", bent}};
}

}  // namespace shapes
