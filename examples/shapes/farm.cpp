// SPDX-License-Identifier: GPL-3.0-or-later
// The tame ones: cow and pig. They share the names of their landmarks, horns included, so that one
// can become the other in halves.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "models.h"

namespace shapes {
namespace {

/// 1 inside big round blots, 0 between them: a cow's coat.
double spots(const Vector& p) {
  struct Spot {
    Vector centre;
    double radius;
  };

  static const std::array<Spot, 6> blots{{{{0.3, 0.96, 0.2}, 0.17},
                                          {{0.3, 0.82, -0.28}, 0.19},
                                          {{-0.31, 0.76, 0.12}, 0.19},
                                          {{-0.2, 1.08, -0.35}, 0.21},
                                          {{0.03, 1.16, -0.03}, 0.14},
                                          {{0.14, 1.22, 0.72}, 0.13}}};
  double inside = 0;
  for (const Spot& spot : blots) {
    const Vector d = p - spot.centre;
    const double angle = std::atan2(d.y(), d.z());
    const double phase = 40 * spot.radius;
    const double wobble = 0.1 * std::sin(2 * angle + phase) + 0.09 * std::sin(3 * angle - phase);
    inside = std::max(inside, spot.radius * (1 + wobble) - d.norm());
  }
  return std::clamp(inside / 0.015, 0.0, 1.0);
}

void add_cow_head(Solid& s, const Skin& coat, const Skin& muzzle) {
  const Skin horn{srgb(0xe9dcb8), srgb(0xe9dcb8)};
  const Skin black{srgb(0x120d0c), srgb(0x120d0c)};
  add(s, ball({0, 1.14, 0.66}, {0.15, 0.17, 0.17}), coat, {0.08, 0.7});
  add(s, limb({0, 1.1, 0.72}, {0, 1.01, 0.84}, 0.125, 0.105), coat, {0.06, 0.7});
  add(s, ball({0, 0.99, 0.875}, {0.135, 0.1, 0.085}), muzzle, {0.03, 0.65});
  add_pair(s, ball({0.225, 1.17, 0.61}, {0.115, 0.055, 0.03}, {0, 20, -12}), coat, {0.03, 0.6});
  add_pair(s, limb({0.09, 1.27, 0.63}, {0.165, 1.35, 0.63}, 0.037, 0.031), horn, {0.015, 0.5});
  add_pair(s, limb({0.165, 1.35, 0.63}, {0.17, 1.455, 0.645}, 0.031, 0.016), horn, {0.01, 0.5});
  add_pair(s, ball({0.1, 1.175, 0.79}, {0.03, 0.036, 0.03}), black, {0.006, 0.32});
  paint_pair(s, {{0.055, 1.015, 0.955}, 0.019, srgb(0x7a4644)});
}

struct Legs {
  double top;
  double thickness;
  std::array<double, 2> depths;  // front and hind
};

void add_legs(Solid& s, const Skin& coat, const Skin& hoof, const Legs& legs) {
  const auto [top, thickness, depths] = legs;
  for (const double z : depths) {
    add_pair(s, limb({0.17, top, z}, {0.175, 0.4 * top, z}, 1.7 * thickness, thickness), coat,
             {0.09});
    add_pair(s, limb({0.175, 0.4 * top, z}, {0.175, 0.1, z}, thickness, 0.9 * thickness), coat,
             {0.03});
    add_pair(s, ball({0.175, 0.03, z + 0.012}, {1.15 * thickness, 0.09, 1.25 * thickness}), hoof,
             {0.015, 0.75});
  }
}

void mark_cow(Solid& s) {
  mark(s, "nose", {0, 0.98, 1.05});
  mark_pair(s, "ear", {0.4, 1.14, 0.55});
  mark_pair(s, "horn", {0.172, 1.52, 0.65});
  mark_pair(s, "front_foot", {0.175, -0.02, 0.33});
  mark_pair(s, "hind_foot", {0.175, -0.02, -0.39});
  mark(s, "tail_tip", {0, 0.2, -0.66});
  mark(s, "tail_root", {0, 1.08, -0.6});
  mark(s, "back", {0, 1.4, -0.06});
  mark(s, "belly", {0, 0.5, 0.08});
  mark(s, "chest", {0, 0.78, 0.54});
  mark(s, "neck_top", {0, 1.35, 0.45});
}

}  // namespace

Solid cow() {
  const Vector white = srgb(0xf5f0e8);
  const Skin coat{white, srgb(0x2b211e)};
  const Skin pink{srgb(0xeeb0a6), srgb(0xeeb0a6)};
  const Skin hoof{srgb(0x40342e), srgb(0x40342e)};
  Solid s{.name = "cow", .edge = 0.033, .pattern = spots, .floor_blend = 0.02};
  add(s, ball({0, 0.82, -0.05}, {0.31, 0.3, 0.52}), coat);
  add(s, ball({0, 0.86, 0.28}, {0.26, 0.28, 0.24}), coat, {0.12});
  add(s, ball({0, 0.88, -0.38}, {0.28, 0.27, 0.22}), coat, {0.12});
  add(s, limb({0, 0.93, 0.38}, {0, 1.12, 0.58}, 0.19, 0.14), coat, {0.12});
  add_cow_head(s, coat, pink);
  add_legs(s, coat, hoof, {0.7, 0.075, {0.31, -0.41}});
  add(s, ball({0, 0.52, -0.25}, {0.13, 0.1, 0.13}), pink, {0.04});
  add(s, limb({0, 1.04, -0.55}, {0, 0.86, -0.65}, 0.04, 0.026), coat, {0.05});
  add(s, limb({0, 0.86, -0.65}, {0, 0.54, -0.66}, 0.026, 0.022), coat, {0.02});
  add(s, ball({0, 0.44, -0.66}, {0.048, 0.11, 0.048}), {srgb(0x2b211e), srgb(0x2b211e)},
      {0.02, 0.8});
  mark_cow(s);
  return s;
}

namespace {

void add_pig_head(Solid& s, const Skin& pink, const Skin& rose) {
  const Skin black{srgb(0x1a1012), srgb(0x1a1012)};
  add(s, ball({0, 0.66, 0.5}, {0.22, 0.21, 0.2}), pink, {0.1, 0.75});
  add(s, limb({0, 0.62, 0.6}, {0, 0.6, 0.74}, 0.115, 0.085), pink, {0.05, 0.65});
  add(s, ball({0, 0.6, 0.775}, {0.1, 0.09, 0.042}), rose, {0.015, 0.5});
  add_pair(s, ball({0.15, 0.865, 0.49}, {0.085, 0.115, 0.032}, {18, 25, -28}), rose, {0.025, 0.55});
  add_pair(s, ball({0.105, 0.735, 0.648}, {0.026, 0.03, 0.026}), black, {0.006, 0.32});
  paint_pair(s, {{0.035, 0.605, 0.81}, 0.018, srgb(0x9c4a52)});
}

/// One turn and a half of a corkscrew that starts at the rump.
void add_curly_tail(Solid& s, const Skin& skin) {
  constexpr int steps = 18;
  const auto at = [](int i) {
    const double t = static_cast<double>(i) / steps;
    const double angle = 3 * std::numbers::pi * t;
    return Vector(0.075 * std::sin(angle), 0.7 + 0.075 * (1 - std::cos(angle)), -0.5 - 0.24 * t);
  };
  for (int i = 0; i < steps; ++i)
    add(s, limb(at(i), at(i + 1), 0.027, i + 1 < steps ? 0.0269 : 0.022), skin, {0.006, 0.6});
}

void mark_pig(Solid& s) {
  mark(s, "nose", {0, 0.6, 0.9});
  mark_pair(s, "ear", {0.22, 1.0, 0.52});
  mark_pair(s, "horn", {0.07, 0.95, 0.5});
  mark_pair(s, "front_foot", {0.175, -0.02, 0.3});
  mark_pair(s, "hind_foot", {0.175, -0.02, -0.32});
  mark(s, "tail_tip", {-0.02, 0.85, -0.78});
  mark(s, "tail_root", {0, 0.62, -0.54});
  mark(s, "back", {0, 1.1, -0.06});
  mark(s, "belly", {0, 0.25, 0});
  mark(s, "chest", {0, 0.4, 0.4});
  mark(s, "neck_top", {0, 1.0, 0.32});
}

}  // namespace

Solid pig() {
  const Skin pink{srgb(0xf2b3ae), srgb(0xf2b3ae)};
  const Skin rose{srgb(0xe08a8c), srgb(0xe08a8c)};
  const Skin hoof{srgb(0x7d4a4a), srgb(0x7d4a4a)};
  Solid s{.name = "pig", .edge = 0.0295, .floor_blend = 0.02};
  add(s, ball({0, 0.58, -0.04}, {0.32, 0.31, 0.48}), pink);
  add(s, ball({0, 0.6, -0.22}, {0.31, 0.31, 0.31}), pink, {0.12});
  add_pig_head(s, pink, rose);
  add_legs(s, pink, hoof, {0.45, 0.075, {0.26, -0.32}});
  add_curly_tail(s, pink);
  mark_pig(s);
  return s;
}

}  // namespace shapes
