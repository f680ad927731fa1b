#include "morphbake/preview/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace morphbake {
namespace {

constexpr int kCells = kPatternSide * kPatternSide;

/// Order of the cells in which neighbours are far apart: the 4 x 4 Bayer matrix.
constexpr std::array<int, kCells> kCellOrder{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};

/// Element `i` of the R2 sequence, in integers so that every machine agrees.
Eigen::Vector2f r2_point(std::uint32_t i) {
  const std::uint32_t x = 0x80000000u + i * 3242174889u;  // 2^32 / 1.32471796
  const std::uint32_t y = 0x80000000u + i * 2447445414u;  // 2^32 / 1.32471796^2
  // 24 bits: a float below 1 holds no more.
  return {static_cast<float>(x >> 8) * 0x1p-24f, static_cast<float>(y >> 8) * 0x1p-24f};
}

/// Keeps areas, and neighbours together (Shirley, Chiu 1997).
Eigen::Vector2f disk_point(const Eigen::Vector2f& square) {
  const Eigen::Vector2f p = 2 * square - Eigen::Vector2f::Ones();
  if (p.isZero()) return {0, 0};
  constexpr float kQuarter = std::numbers::pi_v<float> / 4;
  const bool is_wide = std::abs(p.x()) > std::abs(p.y());
  const float radius = is_wide ? p.x() : p.y();
  const float angle = is_wide ? kQuarter * p.y() / p.x() : kQuarter * (2 - p.x() / p.y());
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace

std::size_t SamplePattern::first_of_pixel(int x, int y) const {
  const int cell = (y & (kPatternSide - 1)) * kPatternSide + (x & (kPatternSide - 1));
  return static_cast<std::size_t>(cell) * static_cast<std::size_t>(samples);
}

SamplePattern make_sample_pattern(int samples) {
  SamplePattern pattern;
  pattern.samples = samples;
  for (int s = 0; s < samples; ++s) {
    pattern.lens.push_back(r2_point(static_cast<std::uint32_t>(s)));
  }
  for (int cell = 0; cell < kCells; ++cell) {
    const int order = kCellOrder[static_cast<std::size_t>(cell)];
    for (int s = 0; s < samples; ++s) {
      const Eigen::Vector2f disk =
          disk_point(r2_point(static_cast<std::uint32_t>(order * samples + s)));
      const float height = std::sqrt(std::max(0.0f, 1 - disk.squaredNorm()));
      pattern.disk.push_back(disk);
      pattern.hemisphere.emplace_back(disk.x(), disk.y(), height);  // Malley's method
    }
  }
  return pattern;
}

// Duff et al. 2017, Building an orthonormal basis, revisited.
void perpendicular_axes(const Eigen::Vector3f& normal, Eigen::Vector3f& a, Eigen::Vector3f& b) {
  const float sign = std::copysign(1.0f, normal.z());
  const float p = -1 / (sign + normal.z());
  const float q = normal.x() * normal.y() * p;
  a = {1 + sign * normal.x() * normal.x() * p, sign * q, -sign * normal.x()};
  b = {q, sign + normal.y() * normal.y() * p, -normal.y()};
}

}  // namespace morphbake
