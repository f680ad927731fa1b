// SPDX-License-Identifier: GPL-3.0-or-later
#include "coat.h"

#include <cmath>
#include <numbers>

namespace shapes {
namespace {

/// -1 to 1, one number a point of the grid.
double grid_noise(const Eigen::Vector3i& at, std::uint32_t seed) {
  std::uint32_t h = seed;
  for (const int coordinate : at) {
    h = (h ^ static_cast<std::uint32_t>(coordinate)) * 0x9e3779b1u;
    h ^= h >> 15;
  }
  h = (h ^ (h >> 13)) * 0x85ebca6bu;
  return static_cast<double>(h ^ (h >> 16)) / 2147483648.0 - 1;
}

/// Smooth between the points of the grid.
double noise(const Vector& p, std::uint32_t seed) {
  const Vector floor = p.array().floor();
  const Vector t = p - floor;
  const Vector share = t.array() * t.array() * (3 - 2 * t.array());
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i step(corner & 1, corner >> 1 & 1, corner >> 2);
    const Vector weights = step.cast<double>().array() * share.array() +
                           (1 - step.cast<double>().array()) * (1 - share.array());
    sum += weights.prod() * grid_noise(floor.cast<int>() + step, seed);
  }
  return sum;
}

/// Where the colour of fur at p grows from: tufts carry it over the borders of the skins.
Vector root_of(const Vector& p) {
  constexpr double reach = 0.007;  // metres
  const Vector tufts = p.cwiseProduct(Vector(110, 40, 110));
  return p + reach * Vector(noise(tufts, 1), 1.6 * noise(tufts, 2), noise(tufts, 3));
}

/// Strands run down; broad patches are a little lighter and darker.
double fur_light(const Vector& p) {
  const double strands = noise(p.cwiseProduct(Vector(330, 90, 330)), 4);
  const double locks = noise(p.cwiseProduct(Vector(120, 45, 120)), 5);
  const double patches = noise(18 * p, 6);
  return 1 + 0.08 * strands + 0.09 * locks + 0.06 * patches;
}

/// Rows of stitches, each a slanting loop.
double wool_light(const Vector& p) {
  constexpr double row = 0.0075;   // metres
  constexpr double stitches = 60;  // around
  const double around = std::atan2(p.x(), p.z() - 0.035) / (2 * std::numbers::pi) * stitches;
  const double slant = std::abs(around - std::floor(around) - 0.5);
  const double level = p.y() / row + slant;
  const double loop = std::abs(level - std::floor(level) - 0.5) + 0.5 * slant;
  return 1.06 - 0.3 * loop + 0.05 * noise(300 * p, 7);
}

}  // namespace

Vector coat_color(const Solid& solid, const Vector& p) {
  if (part_at(solid, p).skin.fabric == Fabric::Wool) return wool_light(p) * color(solid, p);
  const Vector root = root_of(p);
  // What grows beside a scarf or an eye is fur all the same.
  const bool is_fur = part_at(solid, root).skin.fabric == Fabric::Fur;
  return painted(solid, p, fur_light(p) * skin_color(solid, is_fur ? root : p));
}

}  // namespace shapes
