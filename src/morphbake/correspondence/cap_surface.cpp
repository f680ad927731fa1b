#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <utility>

#include "morphbake/correspondence/capped_surface.h"
#include "morphbake/mesh/boundary.h"
#include "morphbake/mesh/closed_mesh.h"

namespace morphbake {
namespace {

/// A landmark this close to a vertex or an edge, in barycentric coordinates, lies on it: what would
/// be split off is a needle that double precision cannot lay on the sphere.
constexpr double kOnEdge = 1e-6;

/// A surface that is being closed and split.
class Splitting {
 public:
  Splitting(const SourceSurface& source, const Triangles& capped, int apex)
      : source_(source),
        mesh_(capped, static_cast<int>(source.mesh.positions.rows()) + (apex >= 0)),
        apex_(apex),
        points_(static_cast<std::size_t>(mesh_.vertex_slots())) {
    for (int f = 0; f < capped.rows(); ++f) {
      source_triangle_.push_back(f < source.mesh.triangles.rows() ? f : -1);
    }
    for (int f = 0; f < source.mesh.triangles.rows(); ++f) {
      for (int k = 0; k < 3; ++k) {
        points_[index(capped(f, k))] = {f, Eigen::Vector3d::Unit(k)};
      }
    }
    for (const Eigen::Vector2i& edge : source.hard_edges) hard_.insert({{edge(0), edge(1)}, true});
  }

  const ClosedMesh& mesh() const { return mesh_; }

  /// The vertex at a point of the source's surface, which may have to be made.
  int vertex_at(const SurfacePoint& at) {
    int best = at.triangle;
    Eigen::Vector3d best_weights = Eigen::Vector3d::Constant(-1e300);
    for (int f = at.triangle; f < mesh_.triangle_slots(); ++f) {
      if (source_triangle_[index(f)] != at.triangle) continue;
      const Eigen::Vector3d weights = weights_in(f, at);
      if (!(weights.minCoeff() > best_weights.minCoeff())) continue;
      best = f;
      best_weights = weights;
    }
    return vertex_in(best, best_weights, at);
  }

  /// Splits each edge between two boundary vertices that is no boundary edge.
  void split_chords(const std::vector<char>& on_boundary) {
    const auto is_on_boundary = [&](int v) {  // vertices made here are not
      return index(v) < on_boundary.size() && on_boundary[index(v)];
    };
    const int count = 3 * mesh_.triangle_slots();
    for (int h = 0; h < count; ++h) {
      const int a = mesh_.from(h), b = mesh_.to(h);
      if (a > b || !is_on_boundary(a) || !is_on_boundary(b)) continue;
      if (mesh_.apex(h) == apex_ || mesh_.apex(mesh_.opposite(h)) == apex_) continue;
      split(h, 0.5);
    }
  }

  CappedSurface finish() &&;

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  /// Barycentric coordinates of a vertex in a source triangle that it lies in.
  Eigen::Vector3d weights_of(int vertex, int triangle) const {
    const SurfacePoint& point = points_[index(vertex)];
    if (point.triangle == triangle) return point.barycentric;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();  // on an edge or corner that both have
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        if (source_.mesh.triangles(point.triangle, k) == source_.mesh.triangles(triangle, j)) {
          weights(j) = point.barycentric(k);
        }
      }
    }
    return weights;
  }

  /// Barycentric coordinates of a point in a triangle of the split surface.
  Eigen::Vector3d weights_in(int f, const SurfacePoint& at) const {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = weights_of(mesh_.from(3 * f + k), at.triangle);
    return corners.inverse() * at.barycentric;
  }

  int vertex_in(int f, const Eigen::Vector3d& weights, const SurfacePoint& at) {
    int largest = 0, smallest = 0;
    weights.maxCoeff(&largest);
    weights.minCoeff(&smallest);
    if (weights(largest) > 1 - 2 * kOnEdge) return mesh_.from(3 * f + largest);
    if (weights(smallest) < kOnEdge) {
      const int h = 3 * f + (smallest + 1) % 3;
      const double a = weights((smallest + 1) % 3), b = weights((smallest + 2) % 3);
      return split(h, b / (a + b));
    }
    const int v = mesh_.split_triangle(f);
    source_triangle_.resize(index(mesh_.triangle_slots()), source_triangle_[index(f)]);
    points_.push_back(at);
    return v;
  }

  /// Puts a vertex on an edge, at a fraction of it.
  int split(int h, double fraction) {
    const int a = mesh_.from(h), b = mesh_.to(h);
    int inside = mesh_.triangle_of(h);  // a triangle of the source beside the edge
    if (source_triangle_[index(inside)] < 0) inside = mesh_.triangle_of(mesh_.opposite(h));
    const int triangle = source_triangle_[index(inside)];
    const int left = source_triangle_[index(mesh_.triangle_of(h))];
    const int right = source_triangle_[index(mesh_.triangle_of(mesh_.opposite(h)))];
    points_.push_back(
        {triangle, (1 - fraction) * weights_of(a, triangle) + fraction * weights_of(b, triangle)});
    const int v = mesh_.split_edge(h);
    source_triangle_.push_back(left);
    source_triangle_.push_back(right);
    const auto hard = hard_.find({std::min(a, b), std::max(a, b)});
    if (hard != hard_.end()) {
      hard_.erase(hard);
      hard_[{std::min(a, v), std::max(a, v)}] = true;
      hard_[{std::min(b, v), std::max(b, v)}] = true;
    }
    return v;
  }

  std::vector<int> new_numbers() const;
  void add_vertices(const std::vector<int>& number, CappedSurface& surface) const;
  void add_triangles(const std::vector<int>& number, CappedSurface& surface) const;

  const SourceSurface& source_;
  ClosedMesh mesh_;
  int apex_;
  std::vector<int> source_triangle_;  ///< one a triangle slot, -1 for caps
  std::vector<SurfacePoint> points_;  ///< one a vertex
  std::map<std::pair<int, int>, bool> hard_;
};

/// One a vertex: the apex comes last, all else keeps its order.
std::vector<int> Splitting::new_numbers() const {
  std::vector<int> number(index(mesh_.vertex_slots()), 0);
  int count = 0;
  for (int v = 0; v < mesh_.vertex_slots(); ++v) {
    if (v != apex_) number[index(v)] = count++;
  }
  if (apex_ >= 0) number[index(apex_)] = count;
  return number;
}

void Splitting::add_vertices(const std::vector<int>& number, CappedSurface& surface) const {
  surface.positions = Positions::Zero(mesh_.vertex_slots(), 3);
  surface.on_source.resize(number.size());
  for (int v = 0; v < mesh_.vertex_slots(); ++v) {
    if (v == apex_) continue;
    const SurfacePoint& point = points_[index(v)];
    surface.on_source[index(number[index(v)])] = point;
    for (int k = 0; k < 3; ++k) {
      surface.positions.row(number[index(v)]) +=
          point.barycentric(k) *
          source_.mesh.positions.row(source_.mesh.triangles(point.triangle, k));
    }
  }
}

void Splitting::add_triangles(const std::vector<int>& number, CappedSurface& surface) const {
  const Triangles triangles = mesh_.triangles();
  std::vector<int> order, caps;
  for (int f = 0; f < triangles.rows(); ++f) {
    (source_triangle_[index(f)] < 0 ? caps : order).push_back(f);
  }
  for (const int f : order) surface.source_triangle.push_back(source_triangle_[index(f)]);
  surface.cap_triangles = static_cast<int>(caps.size());
  surface.on_boundary.assign(number.size(), 0);
  for (const int f : caps) {
    for (const int v : triangles.row(f)) surface.on_boundary[index(number[index(v)])] = v != apex_;
  }
  order.insert(order.end(), caps.begin(), caps.end());
  surface.triangles.resize(triangles.rows(), 3);
  for (int row = 0; row < triangles.rows(); ++row) {
    for (int k = 0; k < 3; ++k) {
      surface.triangles(row, k) = number[index(triangles(order[index(row)], k))];
    }
  }
}

CappedSurface Splitting::finish() && {
  CappedSurface surface;
  // The apex comes last, the caps come last; all else keeps its order.
  const std::vector<int> number = new_numbers();
  if (apex_ >= 0) surface.apex = number[index(apex_)];
  add_vertices(number, surface);
  add_triangles(number, surface);
  for (const auto& [edge, hard] : hard_) {
    const int a = number[index(edge.first)], b = number[index(edge.second)];
    surface.hard_edges.push_back({std::min(a, b), std::max(a, b)});
  }
  return surface;
}

}  // namespace

CappedSurface cap_surface(const SourceSurface& source) {
  const std::map<int, int> boundary = boundary_edges(source.mesh.triangles);
  const auto vertices = static_cast<int>(source.mesh.positions.rows());
  const int apex = boundary.empty() ? -1 : vertices;
  Triangles capped(source.mesh.triangles.rows() + static_cast<Eigen::Index>(boundary.size()), 3);
  capped.topRows(source.mesh.triangles.rows()) = source.mesh.triangles;
  Eigen::Index row = source.mesh.triangles.rows();
  for (const auto& [from, to] : boundary) capped.row(row++) << to, from, apex;
  Splitting splitting(source, capped, apex);
  std::vector<int> landmarks;
  for (const SurfacePoint& landmark : source.landmarks) {
    landmarks.push_back(splitting.vertex_at(landmark));
  }
  if (apex >= 0) {
    std::vector<char> on_boundary(static_cast<std::size_t>(splitting.mesh().vertex_slots()), 0);
    splitting.mesh().around(
        apex, [&](int h) { on_boundary[static_cast<std::size_t>(splitting.mesh().to(h))] = 1; });
    splitting.split_chords(on_boundary);
  }
  CappedSurface surface = std::move(splitting).finish();
  for (const int v : landmarks) surface.landmarks.push_back(v - (apex >= 0 && v > apex));
  return surface;
}

}  // namespace morphbake
