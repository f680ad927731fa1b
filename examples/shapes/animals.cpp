// SPDX-License-Identifier: GPL-3.0-or-later
// The wild ones: egg, giraffe, horse and bird.
#include <algorithm>
#include <cmath>

#include "models.h"

namespace shapes {
namespace {

/// 1 inside the cells of a jittered grid, 0 in the seams between them: a giraffe's patches.
double patches(const Vector& p) {
  constexpr double cell = 0.17;
  constexpr double seam = 0.028;
  const Vector grid = (p / cell).array().floor();
  double nearest = 10;
  double second = 10;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3i cell_offset(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const Vector corner = grid + cell_offset.cast<double>();
    const auto jitter = [&corner](double a, double b, double c) {
      const double x = std::sin(corner.dot(Vector(a, b, c))) * 43758.5453;
      return 0.5 + 0.7 * (x - std::floor(x) - 0.5);
    };
    const Vector seed = corner + Vector(jitter(12.9, 78.2, 37.7), jitter(39.3, 11.1, 83.1),
                                        jitter(73.1, 52.2, 9.1));
    const double d = (p - seed * cell).norm();
    second = std::min(second, std::max(d, nearest));
    nearest = std::min(nearest, d);
  }
  return std::clamp((second - nearest - seam) / 0.012, 0.0, 1.0);
}

void add_giraffe_head(Solid& s, const Skin& coat, const Skin& cream, const Skin& brown) {
  add(s, ball({0, 2.16, 0.70}, {0.105, 0.11, 0.14}, {20, 0, 0}), cream, {0.06, 0.5});
  add(s, limb({0, 2.13, 0.76}, {0, 2.05, 0.93}, 0.08, 0.062), cream, {0.06, 0.5});
  add(s, ball({0, 2.04, 0.945}, {0.078, 0.062, 0.06}), cream, {0.03, 0.5});
  add_pair(s, ball({0.15, 2.215, 0.64}, {0.085, 0.042, 0.022}, {0, 25, 15}), coat, {0.03, 0.5});
  add_pair(s, limb({0.045, 2.23, 0.66}, {0.058, 2.37, 0.62}, 0.024, 0.019), cream, {0.02, 0.5});
  add_pair(s, ball({0.06, 2.385, 0.615}, {0.034, 0.034, 0.034}), brown, {0.01, 0.5});
  add_pair(s, ball({0.088, 2.185, 0.755}, {0.026, 0.03, 0.03}), {srgb(0x15100c), srgb(0x15100c)},
           {0.006, 0.3});
  paint_pair(s, {{0.035, 2.065, 1.002}, 0.014, srgb(0x5a3a28)});
}

void add_giraffe_legs(Solid& s, const Skin& coat, const Skin& cream, const Skin& brown) {
  for (const double z : {0.27, -0.33}) {
    add_pair(s, limb({0.13, 1.06, z}, {0.135, 0.56, z}, 0.115, 0.062), coat, {0.09});
    add_pair(s, limb({0.135, 0.56, z}, {0.135, 0.1, z}, 0.062, 0.05), cream, {0.03});
    add_pair(s, ball({0.135, 0.035, z + 0.012}, {0.072, 0.085, 0.082}), brown, {0.02, 0.7});
  }
}

void mark_giraffe(Solid& s) {
  mark(s, "nose", {0, 2.03, 1.1});
  mark_pair(s, "ear", {0.26, 2.245, 0.60});
  mark_pair(s, "horn", {0.06, 2.45, 0.60});
  mark_pair(s, "front_foot", {0.135, -0.02, 0.29});
  mark_pair(s, "hind_foot", {0.135, -0.02, -0.31});
  mark(s, "tail_tip", {0, 0.55, -0.62});
  mark(s, "tail_root", {0, 1.33, -0.50});
  mark(s, "back", {0, 1.6, -0.1});
  mark(s, "belly", {0, 0.85, -0.03});
  mark(s, "chest", {0, 1.2, 0.5});
  mark(s, "neck_top", {0, 2.15, 0.42});
}

}  // namespace

Solid egg() {
  const Skin shell{srgb(0xf3e4c8), srgb(0xf3e4c8)};
  Solid s{.name = "egg", .edge = 0.0255};
  add(s, limb({0, 0.37, 0}, {0, 0.63, 0}, 0.37, 0.29), shell);
  add(s, ball({0, 0.5, 0}, {0.35, 0.5, 0.35}), shell, {0.25});
  // The giraffe's parts grow where they would sit on a round animal looking forward and up.
  mark(s, "nose", {0, 0.86, 0.33});
  mark_pair(s, "ear", {0.2, 0.93, 0.1});
  mark_pair(s, "horn", {0.07, 1.1, 0.09});
  mark_pair(s, "front_foot", {0.21, 0.05, 0.21});
  mark_pair(s, "hind_foot", {0.21, 0.05, -0.21});
  mark(s, "tail_tip", {0, 0.4, -0.6});
  mark(s, "tail_root", {0, 0.56, -0.5});
  mark(s, "back", {0, 0.78, -0.36});
  mark(s, "belly", {0, -0.1, 0});
  mark(s, "chest", {0, 0.44, 0.6});
  mark(s, "neck_top", {0, 1.1, -0.1});
  return s;
}

Solid giraffe() {
  const Vector sand = srgb(0xf2d08a);
  const Skin coat{sand, srgb(0xa85f22)};
  const Skin cream{sand, sand};
  const Skin brown{srgb(0x4a2c18), srgb(0x4a2c18)};
  Solid s{.name = "giraffe", .edge = 0.0325, .pattern = patches, .floor_blend = 0.02};
  add(s, ball({0, 1.17, -0.05}, {0.24, 0.26, 0.43}, {-12, 0, 0}), coat);
  add(s, ball({0, 1.25, 0.22}, {0.21, 0.25, 0.2}), coat, {0.1});
  add(s, limb({0, 1.32, 0.27}, {0, 2.07, 0.62}, 0.165, 0.085), coat, {0.14});
  add(s, limb({0, 1.52, 0.2}, {0, 2.17, 0.55}, 0.045, 0.035), brown, {0.05});
  add_giraffe_head(s, coat, cream, brown);
  add_giraffe_legs(s, coat, cream, brown);
  add(s, limb({0, 1.24, -0.4}, {0, 1.06, -0.57}, 0.05, 0.027), coat, {0.08});
  add(s, limb({0, 1.06, -0.57}, {0, 0.82, -0.6}, 0.027, 0.022), coat, {0.02});
  add(s, ball({0, 0.74, -0.605}, {0.046, 0.1, 0.046}), brown, {0.02, 0.8});
  mark_giraffe(s);
  return s;
}

namespace {

void add_horse_head(Solid& s, const Skin& coat, const Skin& mane, const Skin& white) {
  add(s, limb({0, 1.66, 0.70}, {0, 1.45, 0.93}, 0.125, 0.085), coat, {0.07, 0.7});
  add(s, ball({0, 1.43, 0.955}, {0.09, 0.085, 0.085}), white, {0.04, 0.6});
  add_pair(s, limb({0.065, 1.75, 0.64}, {0.085, 1.88, 0.63}, 0.04, 0.016), coat, {0.03, 0.5});
  add_pair(s, ball({0.098, 1.655, 0.785}, {0.028, 0.034, 0.034}), {srgb(0x140e0a), srgb(0x140e0a)},
           {0.006, 0.32});
  paint_pair(s, {{0.042, 1.445, 1.03}, 0.016, srgb(0x4b3a35)});
  s.paints.push_back({{0, 1.66, 0.84}, 0.04, white.plain, 0.01});
  add(s, limb({0, 1.77, 0.66}, {0, 1.7, 0.79}, 0.045, 0.028), mane, {0.03, 0.6});
  add(s, limb({0, 1.76, 0.6}, {0, 1.5, 0.33}, 0.05, 0.06), mane, {0.05, 0.8});
  add(s, limb({0, 1.5, 0.33}, {0, 1.33, 0.2}, 0.06, 0.035), mane, {0.05});
}

void add_horse_legs(Solid& s, const Skin& coat, const Skin& white, const Skin& hoof) {
  for (const double z : {0.34, -0.42}) {
    add_pair(s, limb({0.14, 0.92, z}, {0.145, 0.52, z}, 0.13, 0.07), coat, {0.1});
    add_pair(s, limb({0.145, 0.52, z}, {0.145, 0.26, z}, 0.07, 0.055), coat, {0.03});
    add_pair(s, limb({0.145, 0.25, z}, {0.145, 0.12, z}, 0.058, 0.062), white, {0.02});
    add_pair(s, ball({0.145, 0.03, z + 0.015}, {0.082, 0.09, 0.092}), hoof, {0.015, 0.75});
  }
}

void mark_horse(Solid& s) {
  mark(s, "nose", {0, 1.41, 1.1});
  mark_pair(s, "ear", {0.09, 1.95, 0.63});
  mark_pair(s, "front_foot", {0.145, -0.02, 0.36});
  mark_pair(s, "hind_foot", {0.145, -0.02, -0.4});
  mark(s, "tail_tip", {0, 0.42, -0.72});
  mark(s, "tail_root", {0, 1.22, -0.58});
  mark(s, "back", {0, 1.5, -0.08});
  mark(s, "belly", {0, 0.72, -0.03});
  mark(s, "chest", {0, 1.05, 0.6});
  mark(s, "neck_top", {0, 1.9, 0.53});
  mark_pair(s, "wing_root", {0.3, 1.2, 0.22});
  mark_pair(s, "wing_tip", {0.34, 1.26, 0.05});
}

}  // namespace

Solid horse() {
  const Skin coat{srgb(0xb0703c), srgb(0xb0703c)};
  const Skin mane{srgb(0x4a2a1a), srgb(0x4a2a1a)};
  const Skin white{srgb(0xf0e2d0), srgb(0xf0e2d0)};
  const Skin hoof{srgb(0x3a2c26), srgb(0x3a2c26)};
  Solid s{.name = "horse", .edge = 0.0325, .floor_blend = 0.02};
  add(s, ball({0, 1.04, -0.05}, {0.25, 0.27, 0.5}), coat);
  add(s, ball({0, 1.06, 0.3}, {0.22, 0.26, 0.22}), coat, {0.12});
  add(s, ball({0, 1.07, -0.36}, {0.24, 0.25, 0.22}), coat, {0.12});
  add(s, limb({0, 1.16, 0.34}, {0, 1.6, 0.62}, 0.2, 0.125), coat, {0.14});
  add_horse_head(s, coat, mane, white);
  add_horse_legs(s, coat, white, hoof);
  add(s, limb({0, 1.2, -0.52}, {0, 1.09, -0.67}, 0.055, 0.065), mane, {0.06});
  add(s, limb({0, 1.09, -0.67}, {0, 0.86, -0.73}, 0.065, 0.08), mane, {0.08});
  add(s, limb({0, 0.86, -0.73}, {0, 0.52, -0.71}, 0.08, 0.03), mane, {0.08});
  mark_horse(s);
  return s;
}

namespace {

/// Inner and outer panel, and three rounded feathers along the hind edge.
void add_wing(Solid& s, const Skin& plume, const Skin& tip) {
  add_pair(s, limb({0.12, 0.66, 0.1}, {0.42, 0.76, 0.12}, 0.06, 0.045), plume, {0.06, 0.8});
  add_pair(s, ball({0.36, 0.735, 0.02}, {0.28, 0.032, 0.17}, {0, 0, 18}), plume, {0.05, 0.8});
  add_pair(s, ball({0.68, 0.825, 0.0}, {0.25, 0.026, 0.14}, {0, 12, 14}), plume, {0.04, 0.8});
  add_pair(s, ball({0.85, 0.865, -0.06}, {0.19, 0.022, 0.075}, {0, 24, 10}), tip, {0.03, 0.75});
  add_pair(s, ball({0.56, 0.79, -0.12}, {0.09, 0.022, 0.11}, {0, 10, 16}), tip, {0.03, 0.8});
  add_pair(s, ball({0.4, 0.745, -0.13}, {0.09, 0.022, 0.1}, {0, 5, 16}), tip, {0.03, 0.8});
}

void add_bird_head(Solid& s, const Skin& plume, const Skin& orange) {
  add(s, limb({0, 0.68, 0.22}, {0, 0.98, 0.36}, 0.13, 0.085), plume, {0.12});
  add(s, ball({0, 1.04, 0.39}, {0.115, 0.115, 0.125}), plume, {0.05, 0.7});
  add(s, ball({0, 1.015, 0.53}, {0.058, 0.026, 0.095}, {6, 0, 0}), orange, {0.02, 0.5});
  add_pair(s, ball({0.082, 1.075, 0.455}, {0.022, 0.027, 0.027}), {srgb(0x101014), srgb(0x101014)},
           {0.006, 0.3});
}

void mark_bird(Solid& s) {
  mark(s, "nose", {0, 1.0, 0.7});
  mark_pair(s, "ear", {0.16, 1.1, 0.36});
  mark_pair(s, "front_foot", {0.09, 0.4, 0.22});
  mark_pair(s, "hind_foot", {0.1, -0.02, 0.03});
  mark(s, "tail_tip", {0, 0.69, -0.75});
  mark(s, "tail_root", {0, 0.76, -0.33});
  mark(s, "back", {0, 0.95, -0.08});
  mark(s, "belly", {0, 0.38, -0.03});
  mark(s, "chest", {0, 0.62, 0.5});
  mark(s, "neck_top", {0, 1.12, 0.25});
  mark_pair(s, "wing_root", {0.18, 0.78, 0.1});
  mark_pair(s, "wing_tip", {1.1, 0.9, -0.16});
}

}  // namespace

Solid bird() {
  const Skin plume{srgb(0xeef2f6), srgb(0xeef2f6)};
  const Skin tip{srgb(0x7fa6c4), srgb(0x7fa6c4)};
  const Skin orange{srgb(0xf29a2e), srgb(0xf29a2e)};
  Solid s{.name = "bird", .edge = 0.0265, .floor_blend = 0.012};
  add(s, ball({0, 0.58, -0.02}, {0.2, 0.2, 0.34}, {-12, 0, 0}), plume);
  add_bird_head(s, plume, orange);
  add_wing(s, plume, tip);
  add(s, ball({0, 0.64, -0.42}, {0.12, 0.032, 0.19}, {14, 0, 0}), tip, {0.07, 0.8});
  add_pair(s, limb({0.09, 0.45, 0.0}, {0.1, 0.28, 0.0}, 0.07, 0.035), plume, {0.05});
  add_pair(s, limb({0.1, 0.28, 0.0}, {0.1, 0.05, 0.0}, 0.03, 0.027), orange, {0.015, 0.7});
  add_pair(s, ball({0.1, 0.014, 0.05}, {0.065, 0.032, 0.095}), orange, {0.03, 0.65});
  mark_bird(s);
  return s;
}

}  // namespace shapes
