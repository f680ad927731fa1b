#pragma once

#include <cmath>

#include "morphbake/gltf/animated_mesh.h"
#include "shapes/shapes.h"

namespace morphbake {

/// A sphere of one primitive without targets, diagonal 2 sqrt(3).
inline AnimatedMesh still_sphere() {
  const Mesh sphere = test::sphere(12, 16);
  AnimatedMesh mesh;
  AnimatedPrimitive& primitive = mesh.primitives.emplace_back();
  primitive.triangles = sphere.triangles;
  primitive.positions = sphere.positions.cast<float>();
  primitive.normals = primitive.positions;
  mesh.rest_weights.resize(0);
  mesh.weights.values.resize(1, 0);
  return mesh;
}

/// How far along its way a smooth motion of one second is.
inline double eased(double time) { return time * time * (3 - 2 * time); }

/// The end of the way: what lies above moves sideways.
inline Float3s way_of(const AnimatedMesh& mesh) {
  Float3s way = Float3s::Zero(mesh.primitives[0].positions.rows(), 3);
  way.col(0) = 0.5F * mesh.primitives[0].positions.col(2).cwiseMax(0.0F);
  return way;
}

/// One target, whose weight has `keys` eased keys.
inline AnimatedMesh by_one_target(int keys) {
  AnimatedMesh mesh = still_sphere();
  mesh.primitives[0].target_positions = {way_of(mesh)};
  mesh.primitives[0].target_normals = {Float3s()};
  mesh.target_names = {"way"};
  mesh.rest_weights = Eigen::VectorXd::Zero(1);
  mesh.weights.values.resize(keys, 1);
  for (int k = 0; k < keys; ++k) {
    const double time = static_cast<double>(k) / (keys - 1);
    mesh.weights.times.push_back(static_cast<float>(time));
    mesh.weights.values(k, 0) = static_cast<float>(eased(time));
  }
  return mesh;
}

/// One target a frame of the same motion, the first frame being the base.
inline AnimatedMesh by_frames(int frames) {
  AnimatedMesh mesh = still_sphere();
  const Float3s way = way_of(mesh);
  mesh.rest_weights = Eigen::VectorXd::Zero(frames - 1);
  mesh.weights.values = Eigen::MatrixXf::Zero(frames, frames - 1);
  for (int k = 0; k < frames; ++k) {
    const double time = static_cast<double>(k) / (frames - 1);
    mesh.weights.times.push_back(static_cast<float>(time));
    if (k == 0) continue;
    mesh.weights.values(k, k - 1) = 1;
    mesh.target_names.push_back("frame" + std::to_string(k));
    mesh.primitives[0].target_positions.push_back(way * static_cast<float>(eased(time)));
    mesh.primitives[0].target_normals.emplace_back();
  }
  return mesh;
}

}  // namespace morphbake
