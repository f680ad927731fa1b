#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "morphbake/gltf/mesh_choice.h"
#include "morphbake/recipe/landmark.h"

namespace morphbake {

/// How distance on the surface is measured.
enum class DistanceMeasure {
  Geodesic,  ///< straight over the triangles
  Edges,     ///< along edges, as the paper does
  Hops,      ///< number of edges; floods only
};

/// d = 0 within `inner` of the centre, 1 beyond `outer`, linear between (Alexa 2003, section 5.1).
struct BallRegion {
  int source = 0;    ///< the surface on which it is measured
  Place centre;      ///< on that surface
  double inner = 0;  ///< >= 0, in `Recipe::units`
  double outer = 0;  ///< >= inner
  DistanceMeasure distance = DistanceMeasure::Geodesic;
};

/// Between two closed loops of edges: d = 0 inside `inner`, 1 outside `outer`, and
/// d_in / (d_in + d_out) between them (Alexa 2003, section 5.1).
struct RingsRegion {
  int source = 0;
  std::vector<Place> inner;  ///< three or more points, in order; geodesics join them
  std::vector<Place> outer;
  DistanceMeasure distance = DistanceMeasure::Geodesic;
};

/// A vertex attribute: 1 is inside.
struct AttributeMask {
  std::string name;  ///< "COLOR_0", "_MASK"
  int channel = 0;
};

struct MaterialMask {
  NameOrIndex material;
};

struct PrimitiveMask {
  int primitive = 0;
};

/// A picture through texture coordinates: white is inside.
struct ImageMask {
  std::filesystem::path file;  ///< absolute
  int texcoord = 0;
};

/// What the source's own file marks: d = 1 - mask.
struct MaskRegion {
  int source = 0;
  std::variant<AttributeMask, MaterialMask, PrimitiveMask, ImageMask> by;
};

/// d = 1 - value, spread smoothly from a few points (Alexa 2003, section 2.4).
struct ScatteredValue {
  std::string name;  ///< of the landmark, in the recipe
  Place at;
  double value = 0;  ///< 0 to 1
};

struct ScatteredRegion {
  int source = 0;
  std::vector<ScatteredValue> values;
};

/// A parameter that may change with time: one value, or one a key with straight lines between.
template <typename Value>
struct Animated {
  std::vector<double> times;  ///< seconds, rising strictly; none for a constant
  std::vector<Value> values;  ///< one a key, or one

  bool moves() const { return values.size() > 1; }

  Value at(double time) const {
    if (!moves() || time <= times.front()) return values.front();
    for (std::size_t k = 1; k < times.size(); ++k) {
      if (time >= times[k]) continue;
      const double u = (time - times[k - 1]) / (times[k] - times[k - 1]);
      return (1 - u) * values[k - 1] + u * values[k];
    }
    return values.back();
  }
};

/// Behind a plane: n . p <= offset, where n is the normal at length 1.
struct HalfSpace {
  Animated<Eigen::Vector3d> normal;  ///< any length but 0
  Animated<double> offset;
};

/// Between two parallel planes.
struct Slab {
  Animated<Eigen::Vector3d> normal;
  Animated<double> offset;  ///< of the middle
  Animated<double> thickness;
};

struct Box {
  Animated<Eigen::Vector3d> centre;
  Animated<Eigen::Vector3d> size;
};

struct SphereShape {
  Animated<Eigen::Vector3d> centre;
  Animated<double> radius;
};

/// Around an axis, without end unless it has a length.
struct Cylinder {
  Animated<Eigen::Vector3d> centre;
  Animated<Eigen::Vector3d> axis;
  Animated<double> radius;
  Animated<double> length;  ///< no values: without end
};

/// Full at `from`, nothing at `to`, even between them.
struct Ramp {
  Animated<Eigen::Vector3d> from;
  Animated<Eigen::Vector3d> to;
};

/// Inside where the expression in x, y, z and t (seconds) is at most 0.
struct Expression {
  std::string text;
};

/// A part of space, in coordinates about the centre of mass of each of several sources; what they
/// give is averaged (Alexa 2003, section 5.2).
struct SpatialRegion {
  std::variant<HalfSpace, Slab, Box, SphereShape, Cylinder, Ramp, Expression> shape;
  Animated<double> width;    ///< of the soft border, which lies half inside; 0 is hard
  std::vector<int> sources;  ///< whose coordinates count; none: all with a share in the recipe
};

/// Grows over the surface as the amount of its edit grows (Alexa 2003, section 5.3).
struct FloodRegion {
  int source = 0;
  std::vector<Place> seeds;
  DistanceMeasure distance = DistanceMeasure::Geodesic;
  double softness = 0;  ///< width of the front over the way it goes; 0: vertex by vertex, evenly
};

/// Regions joined, as fuzzy sets: largest, smallest and complementary membership.
struct CombinedRegion {
  enum class Kind { Union, Intersection, Difference, RestOf };

  Kind kind = Kind::Union;
  std::vector<int> regions;  ///< indices of earlier or later regions, no cycle
};

/// How a soft border goes from inside to outside.
enum class Falloff { Linear, Smoothstep, Cosine };

struct RegionOfInterest {
  std::string name;
  std::variant<BallRegion, RingsRegion, MaskRegion, ScatteredRegion, SpatialRegion, FloodRegion,
               CombinedRegion>
      shape;
  Falloff falloff = Falloff::Linear;
};

}  // namespace morphbake
