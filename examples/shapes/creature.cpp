// SPDX-License-Identifier: GPL-3.0-or-later
// A small dragon without a care, in three builds on one connectivity.
#include "models.h"

namespace shapes {
namespace {

const Skin scale{srgb(0x55a98c), srgb(0x55a98c)};
const Skin cream{srgb(0xf3e3b4), srgb(0xf3e3b4)};
const Skin coral{srgb(0xe8785a), srgb(0xe8785a)};
const Skin black{srgb(0x14110f), srgb(0x14110f)};

void add_torso(Solid& s) {
  s.group = "torso";
  add(s, ball({0, 0.38, 0}, {0.18, 0.175, 0.26}, {-8, 0, 0}), scale);
  add(s, ball({0, 0.335, 0.045}, {0.15, 0.15, 0.225}, {-8, 0, 0}), cream, {0.03});
  for (const double z : {-0.16, -0.02, 0.12})
    add(s, ball({0, 0.545 + 0.1 * z, z}, {0.036, 0.05, 0.055}, {-10, 0, 0}), coral, {0.04, 0.75});
}

void add_neck_and_head(Solid& s) {
  s.group = "neck";
  add(s, limb({0, 0.45, 0.17}, {0, 0.65, 0.29}, 0.125, 0.09), scale, {0.09});
  s.group = "head";
  add(s, ball({0, 0.725, 0.35}, {0.135, 0.12, 0.14}), scale, {0.05, 0.9});
  add(s, ball({0, 0.685, 0.47}, {0.095, 0.072, 0.085}), cream, {0.05, 0.8});
  add_pair(s, ball({0.085, 0.765, 0.437}, {0.026, 0.033, 0.028}), black, {0.006, 0.45});
  add_pair(s, limb({0.075, 0.82, 0.31}, {0.115, 0.915, 0.285}, 0.036, 0.02), coral, {0.02, 0.6});
  paint_pair(s, {{0.035, 0.715, 0.54}, 0.012, srgb(0x8a6a48)});
}

void add_legs(Solid& s) {
  for (const char* name : {"front legs", "hind legs"}) {
    s.group = name;
    const double z = s.group == "front legs" ? 0.15 : -0.15;
    add_pair(s, limb({0.11, 0.3, z}, {0.12, 0.08, z}, 0.088, 0.065), scale, {0.05});
    add_pair(s, ball({0.122, 0.035, z + 0.022}, {0.078, 0.055, 0.095}), coral, {0.025, 0.8});
  }
}

void add_tail(Solid& s) {
  s.group = "tail";
  add(s, limb({0, 0.37, -0.18}, {0, 0.26, -0.42}, 0.125, 0.07), scale, {0.07});
  add(s, limb({0, 0.26, -0.42}, {0, 0.3, -0.62}, 0.07, 0.038), scale, {0.03});
  add(s, ball({0, 0.325, -0.665}, {0.05, 0.05, 0.065}, {-20, 0, 0}), coral, {0.025, 0.7});
}

void mark_creature(Solid& s) {
  mark(s, "nose", {0, 0.69, 0.7});
  mark_pair(s, "ear", {0.14, 1.0, 0.27});
  mark_pair(s, "front_foot", {0.122, -0.02, 0.18});
  mark_pair(s, "hind_foot", {0.122, -0.02, -0.12});
  mark(s, "tail_tip", {0, 0.345, -0.8});
  mark(s, "tail_root", {0, 0.5, -0.28});
  mark(s, "back", {0, 0.63, -0.02});
  mark(s, "belly", {0, 0.17, 0.02});
  mark(s, "chest", {0, 0.4, 0.36});
  mark(s, "neck_top", {0, 0.75, 0.15});
}

Solid creature() {
  Solid s{.name = "creature_base", .edge = 0.020, .floor_blend = 0.012};
  add_torso(s);
  add_neck_and_head(s);
  add_legs(s);
  add_tail(s);
  mark_creature(s);
  return s;
}

}  // namespace

Family creatures() {
  const Vector torso(0, 0.38, 0);
  const Vector neck(0, 0.45, 0.17);
  const Vector head(0, 0.65, 0.29);
  const Vector tail(0, 0.37, -0.18);
  const Vector front(0, 0, 0.15);
  const Vector hind(0, 0, -0.15);
  const Variant thin{"creature_thin",
                     {{"torso", {0.66, 0.72, 1.05}, torso, {0, 0.13, 0}},
                      {"neck", {0.66, 1.5, 0.85}, neck, {0, 0.13, 0.02}},
                      {"head", {0.85, 0.85, 0.95}, head, {0, 0.22, 0.01}},
                      {"front legs", {0.7, 1.4, 0.72}, front, {0, 0, 0.02}},
                      {"hind legs", {0.7, 1.4, 0.72}, hind, {0, 0, -0.02}},
                      {"tail", {0.66, 0.8, 1.35}, tail, {0, 0.13, 0}}}};
  const Variant stout{"creature_stout",
                      {{"torso", {1.5, 1.25, 1.15}, torso, {0, -0.01, 0}},
                       {"neck", {1.3, 0.75, 1.1}, neck, {0, -0.01, 0.03}},
                       {"head", {1.1, 1.05, 1}, head, {0, -0.07, 0.04}},
                       {"front legs", {1.3, 0.85, 1.25}, front, {0, 0, 0.04}},
                       {"hind legs", {1.3, 0.85, 1.25}, hind, {0, 0, -0.04}},
                       {"tail", {1.4, 1.15, 0.8}, tail, {0, -0.01, -0.03}}}};
  return {creature(), {thin, stout}};
}

}  // namespace shapes
