// SPDX-License-Identifier: GPL-3.0-or-later
// A fox that sits, with a scarf and a hat of its own, and a fennec on the same triangles.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "models.h"

namespace shapes {
namespace {

/// What a look is coloured with.
struct Coat {
  Skin back, front, paws, ears;
  Skin wool, bobble;
};

Skin plain(std::uint32_t rgb, Fabric fabric = Fabric::Fur) {
  return {srgb(rgb), srgb(rgb), fabric};
}

Coat fox_coat() {
  const Skin wool{srgb(0x1d8285), srgb(0xf2e3c0), Fabric::Wool};
  return {plain(0xd9661c),
          plain(0xf8f0e3),
          plain(0x38211b),
          plain(0x4a2a20),
          wool,
          plain(0xf2e3c0, Fabric::Wool)};
}

Coat fennec_coat() {
  const Skin wool{srgb(0xb23a48), srgb(0xf2e3c0), Fabric::Wool};
  return {plain(0xe0b678),
          plain(0xfcf6ea),
          plain(0xd9a868),
          plain(0xe9b9a0),
          wool,
          plain(0xf2e3c0, Fabric::Wool)};
}

const Skin black = plain(0x120c0b, Fabric::Gloss);

/// Stripes of the knitwear: rings of the hat, bars of the scarf.
double stripes(const Vector& p) {
  const bool is_hanging = p.y() < 0.385;
  const double turn = std::atan2(p.x(), p.z() - 0.03) / (2 * std::numbers::pi);
  const double phase = p.y() > 0.6 ? p.y() / 0.036 : is_hanging ? p.y() / 0.05 : 12 * turn;
  return std::clamp(0.5 + 6 * std::cos(2 * std::numbers::pi * phase), 0.0, 1.0);
}

void add_torso(Solid& s, const Coat& coat) {
  s.group = "torso";
  add(s, ball({0, 0.17, -0.05}, {0.125, 0.15, 0.14}), coat.back);
  add(s, limb({0, 0.2, -0.04}, {0, 0.39, 0.025}, 0.12, 0.075), coat.back, {0.06});
  add(s, ball({0, 0.3, 0.06}, {0.075, 0.115, 0.065}, {-12, 0, 0}), coat.front, {0.03});
}

void add_legs(Solid& s, const Coat& coat) {
  s.group = "hind legs";
  add_pair(s, ball({0.115, 0.115, -0.02}, {0.07, 0.108, 0.112}, {0, 12, 0}), coat.back, {0.03});
  add_pair(s, ball({0.158, 0.028, 0.075}, {0.043, 0.036, 0.08}, {0, 14, 0}), coat.paws,
           {0.025, 0.8});
  s.group = "front legs";
  add_pair(s, limb({0.056, 0.27, 0.07}, {0.053, 0.14, 0.105}, 0.045, 0.036), coat.back, {0.04});
  add_pair(s, limb({0.053, 0.13, 0.107}, {0.053, 0.045, 0.12}, 0.035, 0.034), coat.paws, {0.015});
  add_pair(s, ball({0.053, 0.028, 0.138}, {0.042, 0.036, 0.056}), coat.paws, {0.012, 0.8});
}

void add_tail(Solid& s, const Coat& coat) {
  s.group = "tail";
  add(s, limb({0, 0.085, -0.15}, {0.06, 0.075, -0.27}, 0.045, 0.055), coat.back, {0.04});
  add(s, limb({0.06, 0.075, -0.27}, {0.17, 0.14, -0.34}, 0.055, 0.085), coat.back, {0.03});
  add(s, limb({0.17, 0.14, -0.34}, {0.24, 0.29, -0.34}, 0.085, 0.095), coat.back, {0.05});
  add(s, limb({0.24, 0.29, -0.34}, {0.235, 0.41, -0.32}, 0.095, 0.06), coat.front, {0.04});
  add(s, limb({0.235, 0.41, -0.32}, {0.2, 0.5, -0.29}, 0.06, 0.012), coat.front, {0.04});
}

void add_scarf(Solid& s, const Coat& coat) {
  s.group = "neck";
  add(s, ball({0, 0.415, 0.03}, {0.108, 0.042, 0.104}, {8, 0, 0}), coat.wool, {0.008, 0.8});
  add(s, ball({0.05, 0.4, 0.128}, {0.034, 0.034, 0.026}), coat.wool, {0.008, 0.7});
  add(s, ball({0.06, 0.325, 0.118}, {0.034, 0.08, 0.03}, {-10, 10, 12}), coat.wool, {0.008, 0.6});
}

/// A line down from the nose that parts to both cheeks.
void add_smile(Solid& s) {
  constexpr int dots = 24;
  for (int i = 0; i <= dots; ++i) {
    const double t = static_cast<double>(i) / dots;
    const Vector line = on_front(s, 0, 0.505 - 0.02 * t);
    const Vector arc = on_front(s, 0.034 * t, 0.485 - 0.018 * std::sin(2.4 * t));
    for (const Vector& at : {line, arc}) paint_pair(s, {at, 0.0028, srgb(0x4a2a20), 0.001});
  }
}

void add_head(Solid& s, const Coat& coat) {
  s.group = "head";
  add(s, ball({0, 0.545, 0.04}, {0.135, 0.118, 0.12}), coat.back, {0.02, 0.9});
  add_pair(s, limb({0.075, 0.51, 0.075}, {0.165, 0.487, 0.045}, 0.055, 0.008), coat.front,
           {0.03, 0.7});
  s.group = "muzzle";
  add_pair(s, ball({0.03, 0.498, 0.165}, {0.04, 0.036, 0.05}), coat.front, {0.03, 0.7});
  add(s, limb({0, 0.535, 0.12}, {0, 0.516, 0.212}, 0.05, 0.026), coat.back, {0.03, 0.7});
  add(s, ball({0, 0.52, 0.236}, {0.023, 0.017, 0.018}), black, {0.004, 0.45});
  s.group = "head";
  add_pair(s, ball({0.062, 0.562, 0.146}, {0.021, 0.027, 0.017}, {0, 20, 0}), black, {0.004, 0.35});
  paint_pair(s, {{0.062, 0.562, 0.146}, 0.0285, black.plain, 0.003});
  paint_pair(s, {on_front(s, 0.067, 0.574), 0.0075, srgb(0xffffff), 0.002});
  s.paints.push_back({{0, 0.52, 0.236}, 0.0245, black.plain, 0.002});
  add_smile(s);
}

void add_ears(Solid& s, const Coat& coat) {
  s.group = "ears";
  add_pair(s, limb({0.09, 0.625, 0.02}, {0.14, 0.77, 0.0}, 0.055, 0.01), coat.back, {0.02, 0.8});
  add_pair(s, limb({0.1, 0.64, 0.075}, {0.14, 0.745, 0.035}, 0.036, 0.01), coat.ears,
           {0.01, 0.7, true});
}

void mark_fox(Solid& s) {
  mark(s, "nose", {0, 0.52, 0.3});
  mark_pair(s, "ear", {0.145, 0.8, 0.0});
  mark_pair(s, "front_foot", {0.056, -0.02, 0.15});
  mark_pair(s, "hind_foot", {0.158, -0.02, 0.1});
  mark(s, "tail_tip", {0.195, 0.53, -0.28});
  mark(s, "tail_root", {0, 0.16, -0.2});
  mark(s, "back", {0, 0.3, -0.2});
  mark(s, "belly", {0, 0.12, 0.12});
  mark(s, "chest", {0, 0.3, 0.2});
  mark(s, "crown", {0, 0.7, 0.04});
  mark(s, "nape", {0, 0.5, -0.1});
  mark(s, "collar", {0, 0.415, -0.12});
}

Solid body(const Coat& coat) {
  Solid s{.name = "fox", .edge = 0.016, .pattern = stripes, .floor_blend = 0.01};
  add_torso(s, coat);
  add_legs(s, coat);
  add_tail(s, coat);
  add_scarf(s, coat);
  add_head(s, coat);
  add_ears(s, coat);
  mark_fox(s);
  s.fronts["tail"] = {0.77, -0.06, 0.6};
  return s;
}

Solid hat(const Coat& coat) {
  Solid s{.name = "hat", .edge = 0.011, .pattern = stripes};
  s.group = "hat";
  add(s, ball({0, 0.678, 0.045}, {0.064, 0.06, 0.062}), coat.wool);
  add(s, ball({0, 0.655, 0.045}, {0.074, 0.021, 0.072}), coat.wool, {0.004});
  add(s, ball({0, 0.75, 0.045}, {0.03, 0.03, 0.03}), coat.bobble, {0.004, 0.8});
  mark(s, "hat", {0, 0.8, 0.045});
  return s;
}

}  // namespace

std::vector<Look> foxes() {
  const Vector neck(0, 0.42, 0.03);
  const Vector floor(0, 0, 0.03);
  const Vector tail(0, 0.085, -0.15);
  const Variant fennec{"fennec",
                       {{"torso", {1.25, 1, 1.2}, neck},
                        {"hind legs", {1.25, 1, 1.2}, floor},
                        {"front legs", {1.25, 1, 1.2}, floor},
                        {"tail", {1.4, 1.25, 1.25}, tail, {0, 0, -0.03}},
                        {"head", {1.28, 1.18, 1.15}, neck},
                        {"muzzle", {1.0, 1.0, 0.75}, {0, 0.515, 0.12}, {0, 0.012, 0.013}},
                        {"ears", {1.5, 1.75, 1.25}, {0, 0.6, 0.02}, {0, 0.02, 0}},
                        {"hat", {1.28, 1.18, 1.15}, neck}}};
  return {{body(fox_coat()), hat(fox_coat()), {"fox", {}}},
          {body(fennec_coat()), hat(fennec_coat()), fennec}};
}

}  // namespace shapes
