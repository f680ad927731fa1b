#include "morphbake/landmarks/shape_sketch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/boundary.h"
#include "morphbake/mesh/decimate.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/transition/surface_distance.h"

namespace morphbake {
namespace {

constexpr int kSketchVertices = 6000;
constexpr int kSamples = 40;               // sources of distances that stand for the whole surface
constexpr double kLeastProminence = 0.02;  // of the reach: below it are bumps of the triangulation
constexpr double kApart = 0.2;             // of the reach: closer ones are one tip, such as a foot
constexpr double kShort = 0.1;             // of the reach: such a bump grows where it is
constexpr std::size_t kMostTips = 16;

/// The piece of a surface with the largest area.
Mesh largest_piece(const Mesh& surface, int& pieces) {
  const auto count = static_cast<int>(surface.positions.rows());
  const Components components = connected_components(one_rings({count, surface.triangles}));
  pieces = components.count;
  if (pieces == 1) return surface;
  const Eigen::VectorXd areas = vertex_areas(surface.positions, surface.triangles);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(pieces);
  for (int v = 0; v < count; ++v) sums(components.label[static_cast<std::size_t>(v)]) += areas(v);
  int largest = 0;
  sums.maxCoeff(&largest);
  std::vector<int> number(static_cast<std::size_t>(count), -1), vertices, triangles;
  for (int v = 0; v < count; ++v) {
    if (components.label[static_cast<std::size_t>(v)] != largest) continue;
    number[static_cast<std::size_t>(v)] = static_cast<int>(vertices.size());
    vertices.push_back(v);
  }
  for (int f = 0; f < surface.triangles.rows(); ++f) {
    if (number[static_cast<std::size_t>(surface.triangles(f, 0))] >= 0) triangles.push_back(f);
  }
  Mesh piece{surface.positions(vertices, Eigen::all), surface.triangles(triangles, Eigen::all)};
  for (int& vertex : piece.triangles.reshaped()) vertex = number[static_cast<std::size_t>(vertex)];
  return piece;
}

/// Mean distance from each vertex to the surface, scene units: over samples that are spread evenly,
/// each for the area that is closest to it.
Eigen::VectorXd mean_distances(const Mesh& mesh, VertexDistances& distances) {
  const Eigen::VectorXd areas = vertex_areas(mesh.positions, mesh.triangles);
  const Eigen::Index count = mesh.positions.rows();
  std::vector<Eigen::VectorXd> fields;
  Eigen::VectorXd nearest =
      Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> owner(static_cast<std::size_t>(count), 0);
  Eigen::Index next = 0;
  for (std::size_t s = 0; s < kSamples && nearest.maxCoeff(&next) > 0; ++s) {
    fields.push_back(distances.from(static_cast<int>(next)));
    for (Eigen::Index v = 0; v < count; ++v) {
      if (fields[s](v) >= nearest(v)) continue;
      nearest(v) = fields[s](v);
      owner[static_cast<std::size_t>(v)] = s;
    }
  }
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fields.size()));
  for (Eigen::Index v = 0; v < count; ++v) {
    weights(static_cast<Eigen::Index>(owner[static_cast<std::size_t>(v)])) += areas(v);
  }
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(count);
  for (std::size_t s = 0; s < fields.size(); ++s) {
    mean += weights(static_cast<Eigen::Index>(s)) * fields[s];
  }
  return weights.sum() > 0 ? Eigen::VectorXd(mean / weights.sum()) : mean;
}

/// Joins the hills of a function as the water goes down.
class Hills {
 public:
  explicit Hills(std::size_t count) : parent_(count, -1) {}

  bool is_dry(int v) const { return parent_[static_cast<std::size_t>(v)] >= 0; }

  void rise(int v) { parent_[static_cast<std::size_t>(v)] = v; }

  /// The peak of the hill on which `v` lies.
  int peak(int v) {
    int root = v;
    while (parent(root) != root) root = parent(root);
    while (parent(v) != root) v = std::exchange(parent(v), root);
    return root;
  }

  void join(int lower_peak, int higher_peak) { parent(lower_peak) = higher_peak; }

 private:
  int& parent(int v) { return parent_[static_cast<std::size_t>(v)]; }

  std::vector<int> parent_;
};

/// Peaks of `height` that stand out, the most prominent first.
std::vector<Tip> find_tips(const Eigen::VectorXd& height, const OneRings& rings) {
  std::vector<int> order(static_cast<std::size_t>(height.size()));
  std::iota(order.begin(), order.end(), 0);
  const auto is_higher = [&](int a, int b) {
    return height(a) != height(b) ? height(a) > height(b) : a < b;
  };
  std::sort(order.begin(), order.end(), is_higher);
  Hills hills(order.size());
  std::vector<Tip> tips;
  std::vector<double> length(order.size(), 0);
  const auto end_at = [&](int peak, double saddle) {
    double& own = length[static_cast<std::size_t>(peak)];
    if (own == 0) own = height(peak) - saddle;
  };
  for (const int v : order) {
    hills.rise(v);
    const auto i = static_cast<std::size_t>(v);
    for (int n = rings.offsets[i]; n < rings.offsets[i + 1]; ++n) {
      const int neighbour = rings.neighbours[static_cast<std::size_t>(n)];
      if (!hills.is_dry(neighbour)) continue;
      int low = hills.peak(neighbour), high = hills.peak(v);
      if (low == high) continue;
      if (is_higher(low, high)) std::swap(low, high);
      const double prominence = height(low) - height(v);
      if (prominence > kLeastProminence) {
        tips.push_back({low, prominence});
        end_at(low, height(v));
        end_at(high, height(v));
      }
      hills.join(low, high);
    }
  }
  const double range = height.maxCoeff() - height.minCoeff();
  if (range > kLeastProminence) tips.push_back({order.front(), range});
  for (Tip& tip : tips) {
    tip.length = length[static_cast<std::size_t>(tip.vertex)];
    if (tip.length == 0) tip.length = tip.prominence;
  }
  std::stable_sort(tips.begin(), tips.end(),
                   [](const Tip& a, const Tip& b) { return a.prominence > b.prominence; });
  return tips;
}

/// The vertex closest to a tip among those that are no part of its protrusion.
int base_of(const Tip& tip, const Eigen::VectorXd& height, const Eigen::VectorXd& from_tip) {
  int base = tip.vertex;
  if (tip.length < kShort) return base;
  double nearest = std::numeric_limits<double>::infinity();
  for (int v = 0; v < height.size(); ++v) {
    if (height(v) > height(tip.vertex) - tip.length || from_tip(v) >= nearest) continue;
    nearest = from_tip(v);
    base = v;
  }
  return base;
}

}  // namespace

ShapeSketch sketch_shape(const Mesh& surface) {
  ShapeSketch sketch;
  sketch.mesh = decimated(largest_piece(surface, sketch.pieces), kSketchVertices);
  VertexDistances distances(sketch.mesh);
  sketch.mean_distance = mean_distances(sketch.mesh, distances);
  const Eigen::VectorXd areas = vertex_areas(sketch.mesh.positions, sketch.mesh.triangles);
  const double reach = areas.sum() > 0 ? sketch.mean_distance.dot(areas) / areas.sum() : 0;
  if (reach > 0) sketch.reach = reach;
  sketch.mean_distance /= sketch.reach;
  const auto count = static_cast<int>(sketch.mesh.positions.rows());
  for (const Tip& tip :
       find_tips(sketch.mean_distance, one_rings({count, sketch.mesh.triangles}))) {
    const bool is_new = std::none_of(
        sketch.from_tip.begin(), sketch.from_tip.end(),
        [&](const Eigen::VectorXd& distance) { return distance(tip.vertex) < kApart; });
    if (!is_new || sketch.tips.size() == kMostTips) continue;
    sketch.tips.push_back(tip);
    sketch.from_tip.push_back(distances.from(tip.vertex) / sketch.reach);
    sketch.tips.back().base = base_of(tip, sketch.mean_distance, sketch.from_tip.back());
  }
  sketch.boundary = longest_boundary(sketch.mesh);
  return sketch;
}

}  // namespace morphbake
