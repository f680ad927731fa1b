// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "field.h"

namespace shapes {

/// Linear colour from the sRGB number that a colour picker shows.
Vector srgb(std::uint32_t rgb);

/// What a skin is made of, where a model has more than one material.
enum class Fabric { Fur, Wool, Gloss };

struct Skin {
  Vector plain;
  Vector marked;  // where the solid's pattern is 1
  Fabric fabric = Fabric::Fur;
};

/// How a form joins the forms before it.
struct Join {
  double blend = 0.03;  // metres: width over which the crease is rounded
  double detail = 1;    // edge length nearby, as a share of the solid's edge
  bool carve = false;   // taken away instead of added
};

struct Part {
  Form form;
  Skin skin;
  Join join;
  std::string group;  // for variants: what is stretched together
};

/// A ball of paint on the surface.
struct Paint {
  Vector centre;
  double radius;
  Vector color;
  double soft = 0.003;  // metres over which it fades
};

struct LandmarkHint {
  std::string name;
  Vector near;  // the landmark is the closest point of the surface
};

/// What one implicit surface is made of. Parts act in order.
struct Solid {
  std::string name;
  double edge;  // metres: the mesh's edge length where nothing asks for less
  std::vector<Part> parts = {};
  std::string group = {};  // stamped on the parts that are added next
  std::vector<Paint> paints = {};
  std::vector<LandmarkHint> landmarks = {};
  std::function<double(const Vector&)> pattern = {};  // 0 plain .. 1 marked
  std::optional<double> floor_blend = {};     // flat soles on y = 0, their rim rounded so wide
  std::optional<double> cut_z = {};           // only the surface in front of this plane is kept
  std::map<std::string, Vector> fronts = {};  // which way a group's front looks, if not to +Z
};

void add(Solid& solid, const Form& form, const Skin& skin, const Join& join = {});
/// Adds the form and its mirror image.
void add_pair(Solid& solid, const Form& form, const Skin& skin, const Join& join = {});
void paint_pair(Solid& solid, const Paint& paint);
void mark(Solid& solid, const std::string& name, const Vector& near);
/// Marks name_left at +X and name_right at -X.
void mark_pair(Solid& solid, const std::string& name, const Vector& near);

/// Signed distance (to first order) to the blended surface, negative inside.
double field(const Solid& solid, const Vector& p);
/// Colour of the skins alone, and that with the solid's paints over any ground.
Vector skin_color(const Solid& solid, const Vector& p);
Vector painted(const Solid& solid, const Vector& p, const Vector& ground);
Vector color(const Solid& solid, const Vector& p);
double edge_length(const Solid& solid, const Vector& p);
/// The part whose surface, and colour, shows at p.
const Part& part_at(const Solid& solid, const Vector& p);

/// The point of the surface that following the gradient from p leads to.
Vector on_surface(const Solid& solid, const Vector& p);
/// The same within the plane z = p.z.
Vector on_contour(const Solid& solid, const Vector& p);
/// The frontmost point of the surface at the given x and y, which must be inside its outline.
Vector on_front(const Solid& solid, double x, double y);

}  // namespace shapes
