#include "morphbake/connectivity/relax.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "morphbake/correspondence/triangle_energy.h"

namespace morphbake {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr RestLimits kLimits{0.03, 1e-9};
constexpr int kStride = 256;     // vertices or triangles between two looks whether to stop
constexpr double kSlack = 0.05;  // of twice the area of an even triangle of the same size

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// What a sweep holds still: one entry a triangle slot.
struct Frozen {
  std::vector<RestTriangle> rest;
  std::vector<std::vector<Vector3d>> normals;  ///< one list a layer: of the source below
};

Vector3d squared_lengths(const Layer& layer, int a, int b, int c) {
  const Vector3d &pa = layer.lifted[index(a)], &pb = layer.lifted[index(b)],
                 &pc = layer.lifted[index(c)];
  return {(pb - pc).squaredNorm(), (pc - pa).squaredNorm(), (pa - pb).squaredNorm()};
}

void freeze(const LayeredTriangulation& t, Rest rest, Frozen& frozen) {
  const std::size_t counted = rest == Rest::First ? 1 : t.layers.size();
  const auto slots = index(t.mesh.triangle_slots());
  frozen.rest.resize(slots);
  frozen.normals.resize(t.layers.size());
  for (std::vector<Vector3d>& normals : frozen.normals) normals.resize(slots);
  tbb::parallel_for(std::size_t{0}, slots, [&](std::size_t slot) {
    const int f = static_cast<int>(slot);
    if (f % kStride == 0) stop_if_cancelled(t.observer);
    if (!t.mesh.has_triangle(f) || t.is_cap(f)) return;
    const int a = t.mesh.from(3 * f), b = t.mesh.from(3 * f + 1), c = t.mesh.from(3 * f + 2);
    Vector3d mean = Vector3d::Zero();
    for (std::size_t s = 0; s < t.layers.size(); ++s) {
      if (s < counted) mean += squared_lengths(t.layers[s], a, b, c);
      frozen.normals[s][slot] = normal_below(t.layers[s], a, b, c);
    }
    frozen.rest[slot] = rest_triangle(mean / static_cast<double>(counted), kLimits);
  });
}

/// A triangle at the vertex that moves.
struct StarTriangle {
  int a = 0;
  int b = 0;
  bool is_cap = false;
  SurfaceTriangle mapped;       ///< from the mean of all layers; corner 0 is the vertex that moves
  SurfaceTriangle equilateral;  ///< from an even triangle of the same size
  double weight = 0;
};

/// Moves the vertices of one layer.
class LayerRelaxation {
 public:
  LayerRelaxation(const LayeredTriangulation& t, Layer& layer, const Frozen& frozen,
                  const std::vector<Vector3d>& normals, const RelaxOptions& options)
      : t_(t), layer_(layer), frozen_(frozen), normals_(normals), options_(options) {}

  void sweep(bool backwards) {
    const int slots = t_.mesh.vertex_slots();
    for (int i = 0; i < slots; ++i) {
      if (i % kStride == 0) stop_if_cancelled(t_.observer);
      const int v = backwards ? slots - 1 - i : i;
      if (t_.mesh.has_vertex(v) && is_movable(v)) move(v);
    }
  }

 private:
  bool is_movable(int v) const {
    return !t_.is_fixed[index(v)] && options_.patch.has(v) && !t_.is_on_hard_edge(v) &&
           !captures_feature(v);
  }

  bool captures_feature(int v) const {
    if (options_.feature_cosine <= -1) return false;
    Vector3d sum = Vector3d::Zero();
    t_.mesh.around(v, [&](int h) {
      if (!t_.is_cap(ClosedMesh::triangle_of(h))) {
        sum += area_normal(layer_, v, t_.mesh.to(h), t_.mesh.apex(h));
      }
    });
    sum.normalize();
    bool captures = false;
    t_.mesh.around(v, [&](int h) {
      if (t_.is_cap(ClosedMesh::triangle_of(h))) return;
      const Vector3d n = area_normal(layer_, v, t_.mesh.to(h), t_.mesh.apex(h));
      captures |= n.dot(sum) < options_.feature_cosine * n.norm();
    });
    return captures;
  }

  void gather(int v) {
    star_.clear();
    t_.mesh.around(v, [&](int h) {
      StarTriangle& triangle = star_.emplace_back();
      const int f = ClosedMesh::triangle_of(h);
      triangle.a = t_.mesh.to(h);
      triangle.b = t_.mesh.apex(h);
      triangle.is_cap = t_.is_cap(f);
      if (triangle.is_cap) return;
      const RestTriangle& rest = frozen_.rest[index(f)];
      const double size = squared_lengths(layer_, v, triangle.a, triangle.b).sum();
      triangle.mapped = {rest, normals_[index(f)], kSlack * size / (2 * std::sqrt(3.0))};
      for (int k = 0; k < 3; ++k) {
        triangle.mapped.rest.cotangents(k) = rest.cotangents((h % 3 + k) % 3);
      }
      const double area = 0.5 * area_normal(layer_, v, triangle.a, triangle.b).norm();
      triangle.weight = 0.5 * (rest.area + area) / rest.area;
      triangle.equilateral = triangle.mapped;
      triangle.equilateral.rest = {Vector3d::Constant(1 / std::sqrt(3.0)),
                                   0.5 * (rest.area + area)};
    });
  }

  double energy_at(const Vector3d& place, const Vector3d& lifted) const {
    double sum = 0;
    for (const StarTriangle& triangle : star_) {
      const Vector3d &a = layer_.lifted[index(triangle.a)], &b = layer_.lifted[index(triangle.b)];
      const Vector3d &sa = layer_.sphere[index(triangle.a)], &sb = layer_.sphere[index(triangle.b)];
      if (!is_positive(place, sa, sb)) return std::numeric_limits<double>::infinity();
      if (triangle.is_cap) continue;
      sum -= options_.domain * triangle.mapped.rest.area * std::log(determinant(place, sa, sb));
      sum += triangle.weight * surface_energy(triangle.mapped, lifted, a, b) +
             options_.shape * surface_energy(triangle.equilateral, lifted, a, b);
    }
    return sum;
  }

  void move(int v) {
    gather(v);
    const Vector3d place = layer_.sphere[index(v)], lifted = layer_.lifted[index(v)];
    CornerEnergy at, domain;
    for (const StarTriangle& triangle : star_) {
      if (triangle.is_cap) continue;
      const Vector3d &sa = layer_.sphere[index(triangle.a)], &sb = layer_.sphere[index(triangle.b)];
      const double weight = options_.domain * triangle.mapped.rest.area;
      const double d = determinant(place, sa, sb);
      const Vector3d slope = sa.cross(sb - sa) / d;
      domain.energy -= weight * std::log(d);
      domain.gradient -= weight * slope;
      domain.hessian += weight * slope * slope.transpose();
      const std::array corners{lifted, layer_.lifted[index(triangle.a)],
                               layer_.lifted[index(triangle.b)]};
      add_surface_energy(triangle.mapped, corners, triangle.weight, at);
      add_surface_energy(triangle.equilateral, corners, options_.shape, at);
    }
    const int face = layer_.triangle[index(v)];
    Eigen::Matrix<double, 3, 2> axes;
    if (t_.on_boundary[index(v)]) {
      axes << Vector3d(-place.y(), place.x(), 0), Vector3d::Zero();
    } else {
      const TangentAxes tangents = tangent_axes(place);
      axes << tangents.a, tangents.b;
    }
    const Eigen::Matrix<double, 3, 2> along = layer_.atlas.jacobian(place, face) * axes;
    const Vector2d gradient = along.transpose() * at.gradient + axes.transpose() * domain.gradient;
    const Vector2d newton = newton_step(gradient, along.transpose() * at.hessian * along +
                                                      axes.transpose() * domain.hessian * axes);
    const double slope = gradient.dot(newton);
    if (!(-slope > 1e-8 * at.energy)) return;
    const double energy = at.energy + domain.energy;
    const Vector3d direction = axes * newton;
    constexpr double kLongest = 0.3;  // radians
    double share = std::min(1.0, kLongest / direction.norm());
    for (int halvings = 0; halvings < 12; ++halvings, share *= 0.5) {
      const Vector3d next = (place + share * direction).normalized();
      const int f = layer_.atlas.locate(next, face);
      const Vector3d next_lifted = layer_.atlas.position(f, layer_.atlas.weights_at(next, f));
      if (!(energy_at(next, next_lifted) < energy + 1e-4 * share * slope)) continue;
      layer_.sphere[index(v)] = next;
      layer_.lifted[index(v)] = next_lifted;
      layer_.triangle[index(v)] = f;
      return;
    }
  }

  const LayeredTriangulation& t_;
  Layer& layer_;
  const Frozen& frozen_;
  const std::vector<Vector3d>& normals_;
  const RelaxOptions& options_;
  std::vector<StarTriangle> star_;
};

}  // namespace

void relax(LayeredTriangulation& t, const RelaxOptions& options) {
  Frozen frozen;
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    freeze(t, options.rest, frozen);
    tbb::parallel_for(std::size_t{0}, t.layers.size(), [&](std::size_t s) {
      LayerRelaxation(t, t.layers[s], frozen, frozen.normals[s], options).sweep(sweep % 2 == 1);
    });
  }
}

}  // namespace morphbake
