#include "morphbake/connectivity/triangle_cost.h"

#include <algorithm>
#include <cmath>

#include "morphbake/correspondence/triangle_energy.h"

namespace morphbake {

using Eigen::Vector3d;

LayerTriangle layer_triangle(const Layer& layer, int a, int b, int c) {
  const auto at = [&](int v) -> const Vector3d& {
    return layer.lifted[static_cast<std::size_t>(v)];
  };
  LayerTriangle triangle;
  triangle.squared_lengths = {(at(b) - at(c)).squaredNorm(), (at(c) - at(a)).squaredNorm(),
                              (at(a) - at(b)).squaredNorm()};
  const Vector3d normal = area_normal(layer, a, b, c);
  triangle.twice_area = normal.norm();
  triangle.cosine =
      normal_below(layer, a, b, c).dot(normal) / std::max(triangle.twice_area, 1e-300);
  return triangle;
}

double triangle_cost(const std::vector<LayerTriangle>& layers, int& folds) {
  constexpr double kFold = 1000;  // 20 leaves two to seven times as many
  constexpr double kMost = 1e4;   // of one term: a triangle without area is bad enough
  Vector3d mean = Vector3d::Zero();
  for (const LayerTriangle& layer : layers) mean += layer.squared_lengths;
  const RestTriangle rest = rest_triangle(mean / static_cast<double>(layers.size()), {1e-3, 1e-14});
  folds = 0;
  double worst = 0;
  for (const LayerTriangle& layer : layers) {
    const double twice_area = std::max(layer.twice_area, 1e-300);
    const double shape = layer.squared_lengths.sum() / (2 * std::sqrt(3.0) * twice_area);
    const double ratio = 2 * rest.area / twice_area;
    const double distortion =
        0.5 * rest.cotangents.dot(layer.squared_lengths) * (1 + ratio * ratio) / (4 * rest.area);
    const double turn = layer.cosine < 0 ? kFold : 10 * std::max(0.0, 0.3 - layer.cosine);
    folds += layer.cosine < 0;
    worst = std::max(worst, std::min(shape, kMost) + std::min(distortion, kMost) + turn);
  }
  return worst;
}

double triangle_cost(const LayeredTriangulation& t, int f, int& folds) {
  folds = 0;
  if (t.is_cap(f)) return 0;
  std::vector<LayerTriangle> layers;
  for (const Layer& layer : t.layers) {
    layers.push_back(
        layer_triangle(layer, t.mesh.from(3 * f), t.mesh.from(3 * f + 1), t.mesh.from(3 * f + 2)));
  }
  return triangle_cost(layers, folds);
}

}  // namespace morphbake
