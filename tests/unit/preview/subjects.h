#pragma once

#include <cmath>
#include <numbers>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/preview/turntable.h"

namespace morphbake {

/// A triangulated grid over (u, v) in the unit square, mapped by `place` to positions; smooth
/// normals are the caller's. `rings` by `columns` squares.
template <class Place>
AnimatedPrimitive patch(int columns, int rings, Place place) {
  AnimatedPrimitive primitive;
  primitive.positions.resize((columns + 1) * (rings + 1), 3);
  primitive.triangles.resize(columns * rings * 2, 3);
  int face = 0;
  for (int r = 0; r <= rings; ++r) {
    for (int c = 0; c <= columns; ++c) {
      const int v = r * (columns + 1) + c;
      primitive.positions.row(v) =
          place(float(c) / float(columns), float(r) / float(rings)).transpose();
      if (r == rings || c == columns) continue;
      primitive.triangles.row(face++) << v, v + columns + 1, v + 1;
      primitive.triangles.row(face++) << v + 1, v + columns + 1, v + columns + 2;
    }
  }
  return primitive;
}

/// A sphere of radius 1 around `centre` with smooth normals.
inline AnimatedPrimitive sphere(const Eigen::Vector3f& centre, int columns = 48, int rings = 24) {
  constexpr float kPi = std::numbers::pi_v<float>;
  AnimatedPrimitive primitive = patch(columns, rings, [](float u, float v) {
    const float side = std::sin(kPi * v);
    return Eigen::Vector3f(side * std::sin(2 * kPi * u), std::cos(kPi * v),
                           side * std::cos(2 * kPi * u));
  });
  primitive.normals = primitive.positions;
  primitive.positions.rowwise() += centre.transpose();
  return primitive;
}

inline AnimatedMesh still(AnimatedPrimitive primitive) {
  AnimatedMesh mesh;
  mesh.primitives.push_back(std::move(primitive));
  mesh.weights.values.resize(1, 0);
  return mesh;
}

/// A sphere that becomes a tall bent column that leans to one side, in one second.
inline AnimatedMesh growing_column() {
  AnimatedMesh mesh = still(sphere({0, 0, 0}));
  AnimatedPrimitive& primitive = mesh.primitives[0];
  Float3s target = Float3s::Zero(primitive.positions.rows(), 3);
  for (Eigen::Index v = 0; v < target.rows(); ++v) {
    const float height = primitive.positions(v, 1) + 1;
    target.row(v) << 0.5f * height * height, 1.5f * height, 0;
  }
  primitive.target_positions = {target};
  primitive.target_normals = {Float3s::Zero(target.rows(), 3)};
  mesh.target_names = {"column"};
  mesh.weights.times = {0, 1};
  mesh.weights.values.resize(2, 1);
  mesh.weights.values << 0, 1;
  return mesh;
}

/// Small and quick, for tests.
inline TurntableOptions small_options() {
  TurntableOptions options;
  options.width = 96;
  options.height = 96;
  options.frames = 8;
  options.samples = 4;
  return options;
}

}  // namespace morphbake
