// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid.h"

#include <algorithm>
#include <cmath>

namespace shapes {
namespace {

Vector gradient(const Solid& solid, const Vector& p) {
  constexpr double step = 1e-5;
  Vector g;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector h = step * Vector::Unit(axis);
    g[axis] = (field(solid, p + h) - field(solid, p - h)) / (2 * step);
  }
  return g;
}

Vector newton(const Solid& solid, Vector p, const Vector& free_axes) {
  for (int i = 0; i < 20; ++i) {
    const double value = field(solid, p);
    if (std::abs(value) < 1e-9) break;
    const Vector g = gradient(solid, p).cwiseProduct(free_axes);
    p -= g * (value / std::max(g.squaredNorm(), 0.1));
  }
  return p;
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// The running blend of all parts before, with one more part at distance d.
double joined(double value, const Join& join, double d) {
  return join.carve ? -smooth_min(-value, d, join.blend) : smooth_min(value, d, join.blend);
}

/// How far a part comes out of the blend before it; negative where it is hidden inside.
double lead(const Join& join, double value, double d) {
  return join.carve ? -d - value : value - d;
}

}  // namespace

Vector srgb(std::uint32_t rgb) {
  Vector linear;
  for (int channel = 0; channel < 3; ++channel) {
    const double value = static_cast<double>((rgb >> (8 * (2 - channel))) & 0xff) / 255;
    linear[channel] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  return linear;
}

void add(Solid& solid, const Form& form, const Skin& skin, const Join& join) {
  solid.parts.push_back({form, skin, join, solid.group});
}

void add_pair(Solid& solid, const Form& form, const Skin& skin, const Join& join) {
  add(solid, form, skin, join);
  add(solid, mirrored(form), skin, join);
}

void paint_pair(Solid& solid, const Paint& paint) {
  Paint other = paint;
  other.centre.x() = -other.centre.x();
  solid.paints.push_back(paint);
  solid.paints.push_back(other);
}

void mark(Solid& solid, const std::string& name, const Vector& near) {
  solid.landmarks.push_back({name, near});
}

void mark_pair(Solid& solid, const std::string& name, const Vector& near) {
  mark(solid, name + "_left", near);
  mark(solid, name + "_right", {-near.x(), near.y(), near.z()});
}

double field(const Solid& solid, const Vector& p) {
  double value = 1e3;
  for (const Part& part : solid.parts) value = joined(value, part.join, distance(part.form, p));
  if (solid.floor_blend) value = -smooth_min(-value, p.y(), *solid.floor_blend);
  return value;
}

// Colours follow the same running blend as the surface, so that a part shows exactly where it comes
// out of the others. They change within half an edge either way: sharp, but no staircase.
Vector skin_color(const Solid& solid, const Vector& p) {
  const double marked = solid.pattern ? solid.pattern(p) : 0;
  const double sharpness = edge_length(solid, p) / 2;
  Vector result = Vector::Zero();
  double value = 1e3;
  for (const Part& part : solid.parts) {
    const double d = distance(part.form, p);
    const Vector own = part.skin.plain + marked * (part.skin.marked - part.skin.plain);
    result += smooth_step(-sharpness, sharpness, lead(part.join, value, d)) * (own - result);
    value = joined(value, part.join, d);
  }
  return result;
}

Vector painted(const Solid& solid, const Vector& p, const Vector& ground) {
  Vector result = ground;
  for (const Paint& paint : solid.paints) {
    const double share = 1 - smooth_step(paint.radius - paint.soft, paint.radius + paint.soft,
                                         (p - paint.centre).norm());
    result += share * (paint.color - result);
  }
  return result;
}

Vector color(const Solid& solid, const Vector& p) {
  return painted(solid, p, skin_color(solid, p));
}

double edge_length(const Solid& solid, const Vector& p) {
  constexpr double growth = 0.3;  // metres of edge a metre of distance: neighbours stay alike
  double length = solid.edge;
  for (const Part& part : solid.parts)
    if (part.join.detail < 1)
      length = std::min(
          length, part.join.detail * solid.edge + growth * std::max(0.0, distance(part.form, p)));
  return length;
}

const Part& part_at(const Solid& solid, const Vector& p) {
  const Part* shown = &solid.parts.front();
  double value = 1e3;
  for (const Part& part : solid.parts) {
    const double d = distance(part.form, p);
    if (lead(part.join, value, d) > 0) shown = &part;
    value = joined(value, part.join, d);
  }
  return *shown;
}

Vector on_surface(const Solid& solid, const Vector& p) { return newton(solid, p, {1, 1, 1}); }

Vector on_contour(const Solid& solid, const Vector& p) { return newton(solid, p, {1, 1, 0}); }

Vector on_front(const Solid& solid, double x, double y) {
  double z = 1;
  while (field(solid, {x, y, z}) > 1e-6 && z > -1) z -= 0.5 * field(solid, {x, y, z});
  return {x, y, z};
}

}  // namespace shapes
