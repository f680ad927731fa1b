// SPDX-License-Identifier: GPL-3.0-or-later
#include "paint.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "png.h"

namespace shapes {
namespace {

/// What of the surface a texel shows.
struct Texel {
  double outside = std::numeric_limits<double>::infinity();  // texels from the triangle, 0 inside
  int triangle = -1;
  Vector at = Vector::Zero();
};

class Canvas {
 public:
  explicit Canvas(int size) : size_(size), texels_(index(0, size)) {}

  /// Lays a triangle of the surface on the texels that it covers, and around them.
  void lay(const Mesh& mesh, const Unwrapped& flat, int triangle) {
    const Eigen::Matrix<double, 3, 2> corners = size_ * flat.uv.middleRows<3>(3 * triangle);
    const Eigen::RowVector2i low =
        (corners.colwise().minCoeff().array() - reach).floor().cast<int>().max(0);
    const Eigen::RowVector2i high =
        (corners.colwise().maxCoeff().array() + reach).ceil().cast<int>().min(size_ - 1);
    if (twice_area(corners) < 1e-6) return;  // no texel's centre is in it
    Eigen::Matrix3d points;
    for (int k = 0; k < 3; ++k)
      points.col(k) = mesh.positions.row(mesh.triangles(triangle, k)).transpose();
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) {
        const Vector shares = barycentric(corners, {x + 0.5, y + 0.5});
        const double outside = distance_outside(corners, shares);
        if (outside > reach) continue;
        offer(x, y, {outside, triangle, points * shares});
      }
  }

  /// Colours of all texels: around the charts their neighbours', beyond the mean of all charts.
  std::string png(const Painter& painter) const {
    std::vector<Vector> colors(texels_.size(), Vector::Zero());
    std::vector<bool> is_painted(texels_.size(), false);
    for (std::size_t i = 0; i < texels_.size(); ++i) {
      if (texels_[i].triangle < 0) continue;
      colors[i] = painter(texels_[i].triangle, texels_[i].at);
      is_painted[i] = true;
    }
    for (int ring = 0; ring < rings; ++ring) spread(colors, is_painted);
    fill(colors, is_painted);
    std::vector<std::uint8_t> rgb;
    for (const Vector& color : colors)
      for (const double channel : color) rgb.push_back(srgb_byte(channel));
    return shapes::png(size_, rgb);
  }

 private:
  static constexpr double reach = 3;  // texels that paint runs over an edge
  static constexpr int rings = 8;     // texels that its colours spread from there

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) +
           static_cast<std::size_t>(x);
  }

  static Vector barycentric(const Eigen::Matrix<double, 3, 2>& corners,
                            const Eigen::RowVector2d& p) {
    Eigen::Matrix3d system;
    system << corners.transpose(), Eigen::RowVector3d::Ones();
    return system.inverse() * Vector(p.x(), p.y(), 1);
  }

  static double twice_area(const Eigen::Matrix<double, 3, 2>& corners) {
    const Eigen::RowVector2d u = corners.row(1) - corners.row(0);
    const Eigen::RowVector2d v = corners.row(2) - corners.row(0);
    return std::abs(u.x() * v.y() - u.y() * v.x());
  }

  /// Of the edge that is furthest on the wrong side.
  static double distance_outside(const Eigen::Matrix<double, 3, 2>& corners, const Vector& shares) {
    double furthest = 0;
    for (int k = 0; k < 3; ++k) {
      const double edge = (corners.row((k + 1) % 3) - corners.row((k + 2) % 3)).norm();
      furthest = std::max(furthest, -shares[k] * twice_area(corners) / edge);
    }
    return furthest;
  }

  void offer(int x, int y, const Texel& texel) {
    Texel& best = texels_[index(x, y)];
    const bool both_inside = texel.outside == 0 && best.outside == 0;
    if (both_inside && (texel.at - best.at).norm() > 1e-3)
      throw std::runtime_error("the texture shows two places of the surface at one place");
    if (texel.outside < best.outside) best = texel;
  }

  static void fill(std::vector<Vector>& colors, const std::vector<bool>& is_painted) {
    Vector sum = Vector::Zero();
    double count = 0;
    for (std::size_t i = 0; i < colors.size(); ++i) {
      if (!is_painted[i]) continue;
      sum += colors[i];
      ++count;
    }
    for (std::size_t i = 0; i < colors.size(); ++i)
      if (!is_painted[i]) colors[i] = sum / count;
  }

  /// One ring around all that is painted.
  void spread(std::vector<Vector>& colors, std::vector<bool>& is_painted) const {
    const std::vector<bool> before = is_painted;
    for (int y = 0; y < size_; ++y)
      for (int x = 0; x < size_; ++x) {
        const auto i = index(x, y);
        if (before[i]) continue;
        Vector sum = Vector::Zero();
        int count = 0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, size_ - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, size_ - 1); ++u) {
            const auto n = index(u, v);
            if (before[n]) sum += colors[n];
            count += before[n];
          }
        if (count > 0) colors[i] = sum / count;
        is_painted[i] = count > 0;
      }
  }

  static std::uint8_t srgb_byte(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    const double value = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * value));
  }

  int size_;
  std::vector<Texel> texels_;
};

}  // namespace

std::string paint(const Mesh& mesh, const Unwrapped& flat, int size, const Painter& painter) {
  Canvas canvas(size);
  for (std::size_t f = 0; f < flat.charts.size(); ++f) canvas.lay(mesh, flat, static_cast<int>(f));
  return canvas.png(painter);
}

}  // namespace shapes
