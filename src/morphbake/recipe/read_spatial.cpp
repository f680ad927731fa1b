#include <fmt/core.h>

#include <type_traits>

#include "morphbake/recipe/read_regions.h"
#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

template <typename Value>
Value value_of(const Json& json) {
  if constexpr (std::is_same_v<Value, double>) {
    return json.get<double>();
  } else {
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
  }
}

/// A field that may be given by keys; `otherwise` where there is none.
template <typename Value>
Animated<Value> read_animated(Reading& reading, const Json& owner, const std::string& pointer,
                              const char* field, Value otherwise) {
  if (!owner.contains(field)) return {{}, {otherwise}};
  const Json& json = owner[field];
  if (!json.is_object()) return {{}, {value_of<Value>(json)}};
  Animated<Value> animated;
  const Json& keys = json["keys"];
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto time = keys[k]["time"].get<double>();
    if (k > 0 && time <= animated.times.back()) {
      complain(reading, "recipe.out-of-range",
               child_pointer(child_pointer(pointer, field) + "/keys", k) + "/time",
               fmt::format("this key is at {} s, not after the one before at {} s", time,
                           animated.times.back()),
               "times of keys rise");
    }
    animated.times.push_back(time);
    animated.values.push_back(value_of<Value>(keys[k]["value"]));
  }
  return animated;
}

/// Reads the fields of one shape.
struct ShapeFields {
  Reading& reading;
  const Json& json;
  std::string pointer;

  Animated<double> number(const char* field, double otherwise = 0) const {
    return read_animated<double>(reading, json, pointer, field, otherwise);
  }

  Animated<Eigen::Vector3d> vector(const char* field) const {
    return read_animated<Eigen::Vector3d>(reading, json, pointer, field, {0, 0, 0});
  }

  /// A length an axis.
  Animated<Eigen::Vector3d> size(const char* field) const {
    Animated<Eigen::Vector3d> size = vector(field);
    for (const Eigen::Vector3d& each : size.values) {
      if (each.minCoeff() >= 0) continue;
      complain(reading, "recipe.out-of-range", child_pointer(pointer, field),
               fmt::format("({:.4g}, {:.4g}, {:.4g}) is no size", each.x(), each.y(), each.z()),
               "give three lengths of 0 or more");
      break;
    }
    return size;
  }

  /// A direction; the zero vector is none.
  Animated<Eigen::Vector3d> direction(const char* field) const {
    Animated<Eigen::Vector3d> direction = vector(field);
    for (const Eigen::Vector3d& each : direction.values) {
      if (!each.isZero(0)) continue;
      complain(reading, "recipe.out-of-range", child_pointer(pointer, field),
               "(0, 0, 0) is no direction", "give for example [1, 0, 0]");
      return direction;
    }
    for (std::size_t k = 1; k < direction.values.size(); ++k) {
      const Eigen::Vector3d before = direction.values[k - 1].stableNormalized();
      if ((before + direction.values[k].stableNormalized()).norm() > 1e-6) continue;
      complain(reading, "recipe.out-of-range",
               child_pointer(child_pointer(pointer, field) + "/keys", k) + "/value",
               "it is opposite to the key before: between them the direction vanishes",
               "give a third key between them that is turned sideways");
      break;
    }
    return direction;
  }
};

void read_spatial_shape(Reading& reading, const Json& json, const std::string& pointer,
                        SpatialRegion& region) {
  const auto of = [&](const char* shape) {
    return ShapeFields{reading, json[shape], pointer + "/" + shape};
  };
  if (json.contains("half_space")) {
    const ShapeFields half = of("half_space");
    region.shape = HalfSpace{half.direction("normal"), half.number("offset")};
  } else if (json.contains("slab")) {
    const ShapeFields slab = of("slab");
    region.shape = Slab{slab.direction("normal"), slab.number("offset"), slab.number("thickness")};
  } else if (json.contains("box")) {
    const ShapeFields box = of("box");
    region.shape = Box{box.vector("centre"), box.size("size")};
  } else if (json.contains("sphere")) {
    const ShapeFields sphere = of("sphere");
    region.shape = SphereShape{sphere.vector("centre"), sphere.number("radius")};
  } else if (json.contains("cylinder")) {
    const ShapeFields cylinder = of("cylinder");
    Cylinder shape{
        cylinder.vector("centre"), cylinder.direction("axis"), cylinder.number("radius"), {}};
    if (cylinder.json.contains("length")) shape.length = cylinder.number("length");
    region.shape = shape;
  } else if (json.contains("ramp")) {
    const ShapeFields ramp = of("ramp");
    region.shape = Ramp{ramp.vector("from"), ramp.vector("to")};
  } else if (json.contains("expression")) {
    region.shape = Expression{json["expression"].get<std::string>()};
  }
}

}  // namespace

SpatialRegion read_spatial(Reading& reading, const Json& json, const std::string& pointer) {
  check_one_of(reading, json,
               {"half_space", "slab", "box", "sphere", "cylinder", "ramp", "expression"}, "shape",
               pointer);
  SpatialRegion region;
  region.width = read_animated<double>(reading, json, pointer, "width", 0);
  if (json.contains("ramp") && json.contains("width")) {
    complain(reading, "recipe.out-of-range", pointer + "/width", "a ramp has no width",
             "it is as soft as it is long: move its ends");
  }
  const Json on = json.value("on", Json::array());
  for (std::size_t i = 0; i < on.size(); ++i) {
    const int source = look_up(reading, reading.recipe.sources, "source", on[i],
                               child_pointer(pointer + "/on", i));
    if (source >= 0) region.sources.push_back(source);
  }
  read_spatial_shape(reading, json, pointer, region);
  return region;
}

}  // namespace morphbake
