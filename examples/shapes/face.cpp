// SPDX-License-Identifier: GPL-3.0-or-later
// A friendly face, cut off behind the ears, and two relatives with other noses. In the relatives
// the nose also sits at another height and the head has other proportions: features at other
// places are what interpolation of absolute coordinates cannot cope with.
#include <vector>

#include "models.h"

namespace shapes {
namespace {

const Skin skin{srgb(0xf0bf9c), srgb(0xf0bf9c)};
const Skin rosy{srgb(0xeaa88a), srgb(0xeaa88a)};
const Skin lip{srgb(0xc4605c), srgb(0xc4605c)};
const Skin hair{srgb(0x5b3420), srgb(0x5b3420)};
const Skin eye{srgb(0xfbf8f2), srgb(0xfbf8f2)};

void add_head(Solid& s) {
  s.group = "head";
  add(s, ball({0, 0.15, 0}, {0.084, 0.115, 0.1}), skin);
  add_pair(s, ball({0.042, 0.115, 0.058}, {0.034, 0.032, 0.031}), skin, {0.035, 0.9});
  add_pair(s, ball({0.09, 0.14, 0.012}, {0.011, 0.027, 0.018}, {0, -25, 0}), rosy, {0.008, 0.7});
  add_pair(s, limb({0.016, 0.181, 0.09}, {0.052, 0.179, 0.074}, 0.011, 0.01), skin, {0.02, 0.7});
  s.group = "chin";
  add(s, ball({0, 0.064, 0.054}, {0.037, 0.028, 0.03}), skin, {0.055, 0.8});
  s.group = "head";
  add(s, ball({0.012, 0.196, -0.005}, {0.09, 0.079, 0.1}, {-8, 0, 0}), hair, {0.006, 0.8});
  add(s, ball({-0.028, 0.218, 0.06}, {0.056, 0.022, 0.027}, {12, -14, 14}), hair, {0.012, 0.8});
  add(s, ball({0.046, 0.214, 0.058}, {0.038, 0.018, 0.024}, {12, 24, -22}), hair, {0.012, 0.8});
}

using Path = std::vector<Eigen::Vector2d>;

/// The path laid on the surface, seen from the front.
std::vector<Vector> traced(const Solid& s, const Path& path) {
  std::vector<Vector> points;
  for (const Eigen::Vector2d& p : path) points.push_back(on_front(s, p.x(), p.y()));
  return points;
}

struct Cord {
  double radius;
  double taper;  // a piece's end over its beginning
};

void add_cord_pair(Solid& s, const std::vector<Vector>& at, Cord cord, const Skin& cord_skin,
                   const Join& join) {
  for (std::size_t i = 0; i + 1 < at.size(); ++i, cord.radius *= cord.taper)
    add_pair(s, limb(at[i], at[i + 1], cord.radius, cord.radius * cord.taper), cord_skin, join);
}

void add_eyes(Solid& s) {
  s.group = "head";
  add_pair(s, ball({0.035, 0.157, 0.1}, {0.023, 0.017, 0.017}), skin, {0.018, 0.6, true});
  add_pair(s, ball({0.0345, 0.1565, 0.0765}, {0.0185, 0.017, 0.017}), eye, {0.002, 0.25});
  add_pair(s, ball({0.0345, 0.1605, 0.0752}, {0.0198, 0.0165, 0.0178}, {-10, 0, 0}), skin,
           {0.003, 0.3});
  const Path brow{{0.018, 0.1875}, {0.027, 0.1915}, {0.038, 0.1925}, {0.05, 0.189}};
  add_cord_pair(s, traced(s, brow), {0.0042, 0.88}, hair, {0.003, 0.35});
  paint_pair(s, {{0.0325, 0.155, 0.0945}, 0.009, srgb(0x4d7a52), 0.0008});
  paint_pair(s, {{0.0325, 0.155, 0.0945}, 0.0052, srgb(0x101010), 0.0008});
  paint_pair(s, {{0.052, 0.119, 0.088}, 0.012, srgb(0xea9a80), 0.01});
}

void add_nose(Solid& s) {
  s.group = "nose";
  add(s, limb({0, 0.163, 0.091}, {0, 0.13, 0.108}, 0.0075, 0.01), skin, {0.016, 0.6});
  add(s, ball({0, 0.1255, 0.114}, {0.0145, 0.0125, 0.0135}), rosy, {0.008, 0.5});
  add_pair(s, ball({0.0125, 0.121, 0.105}, {0.0085, 0.0075, 0.0095}), skin, {0.005, 0.5});
}

void add_mouth(Solid& s) {
  s.group = "mouth";
  add(s, ball({0, 0.096, 0.062}, {0.036, 0.027, 0.028}), skin, {0.03, 0.7});
  // Both lips are traced before either is added, or the second would lie on the first.
  const auto lower = traced(s, {{0, 0.088}, {0.009, 0.0895}, {0.018, 0.094}, {0.025, 0.1}});
  const auto upper = traced(s, {{0.001, 0.0948}, {0.006, 0.0963}, {0.016, 0.098}, {0.0255, 0.101}});
  add_cord_pair(s, lower, {0.0046, 0.8}, lip, {0.004, 0.26});
  add_cord_pair(s, upper, {0.0036, 0.82}, lip, {0.003, 0.26});
}

void mark_face(Solid& s) {
  mark(s, "nose_tip", {0, 0.1265, 0.14});
  mark(s, "nose_bridge", on_front(s, 0, 0.162));
  mark_pair(s, "mouth", on_front(s, 0.026, 0.101));
  mark(s, "mouth_center", on_front(s, 0, 0.092));
  mark_pair(s, "eye", on_front(s, 0.033, 0.155));
  mark(s, "chin", on_front(s, 0, 0.055));
  mark(s, "brow_center", on_front(s, 0, 0.188));
  mark_pair(s, "cheek", on_front(s, 0.052, 0.117));
}

Solid face() {
  Solid s{.name = "face", .edge = 0.0066, .cut_z = -0.004};
  add_head(s);
  add_eyes(s);
  add_nose(s);
  add_mouth(s);
  mark_face(s);
  return s;
}

}  // namespace

Family faces() {
  const Vector middle(0, 0.15, 0);
  const Vector nose_root(0, 0.135, 0.09);
  const Variant long_nose{"face_long_nose",
                          {{"nose", {1.25, 1.25, 2.6}, nose_root, {0, -0.026, 0}},
                           {"mouth", {1, 1, 1}, middle, {0, -0.024, 0}},
                           {"chin", {1, 1, 1}, middle, {0, -0.012, 0}},
                           {"", {1.07, 1.04, 1}, middle}}};
  const Variant short_nose{"face_short_nose",
                           {{"nose", {0.9, 0.65, 0.55}, nose_root, {0, 0.021, 0}},
                            {"mouth", {1.12, 1.05, 1}, middle, {0, 0.012, 0}},
                            {"", {1.05, 0.96, 1}, middle}}};
  return {face(), {long_nose, short_nose}};
}

}  // namespace shapes
