#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <vector>

#include "morphbake/correspondence/sphere_layout.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

/// A vertex of more neighbours is the end of collapses, not their start, until too little else is
/// left: rating them anew after each of its neighbours' collapses would cost the square of their
/// number.
constexpr int kCrowded = 64;
constexpr int kStride = 256;  // collapses tried between two looks whether to stop

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Costs and rules of collapses; keeps a queue of them.
class Coarsening {
 public:
  Coarsening(SphereLayout& layout, const CollapseFilter& allowed, const Observer& observer)
      : layout_(layout),
        allowed_(allowed),
        observer_(observer),
        quadrics_(layout.positions.size(), Eigen::Matrix4d::Zero()),
        is_landmark_(layout.positions.size(), 0),
        stamps_(layout.positions.size(), 0) {
    for (const int v : layout.surface->landmarks) is_landmark_[index(v)] = 1;
    const ClosedMesh& mesh = layout.mesh;
    for (int f = 0; f < mesh.triangle_slots(); ++f) {
      if (f % kStride == 0) stop_if_cancelled(observer);
      if (mesh.has_triangle(f)) add_plane(f);
    }
    push_all(kCrowded);
  }

  void run(int count) {
    ClosedMesh& mesh = layout_.mesh;
    bool retried = false;
    for (int tried = 0; mesh.vertex_count() > count; ++tried) {
      if (tried % kStride == 0) stop_if_cancelled(observer_);
      if (queue_.empty()) {
        if (retried) return;  // nothing was possible since the queue was filled
        retried = true;
        push_all(mesh.vertex_count());
        continue;
      }
      const auto [cost, u, v, stamp] = queue_.top();
      queue_.pop();
      if (!mesh.has_vertex(u) || stamp != stamps_[index(u)]) continue;
      const int h = mesh.find(u, v);
      if (h < 0) continue;
      const double now = cost_of(h);
      if (now > cost * 1.0001) {
        queue_.push({now, u, v, stamp});
        continue;
      }
      if (!keeps_boundary(h) || !mesh.can_collapse(h) || (allowed_ && !allowed_(mesh, h))) continue;
      collapse(h);
      retried = false;
    }
  }

 private:
  using Entry = std::tuple<double, int, int, int>;  // cost, removed, kept, stamp of removed

  void add_plane(int f) {
    const ClosedMesh& mesh = layout_.mesh;
    const int a = mesh.from(3 * f), b = mesh.from(3 * f + 1), c = mesh.from(3 * f + 2);
    const int apex = layout_.surface->apex;
    if (apex >= 0 && (a == apex || b == apex || c == apex)) return;
    const Vector3d &p = layout_.positions[index(a)], &q = layout_.positions[index(b)],
                   &r = layout_.positions[index(c)];
    const Vector3d normal = (q - p).cross(r - p);
    const double twice_area = normal.norm();
    if (!(twice_area > 0)) return;
    Eigen::Vector4d plane;
    plane << normal / twice_area, -normal.dot(p) / twice_area;
    for (const int v : {a, b, c}) quadrics_[index(v)] += twice_area * plane * plane.transpose();
  }

  void push_around(int u) {
    layout_.mesh.around(u, [&](int h) {
      queue_.push({cost_of(h), u, layout_.mesh.to(h), stamps_[index(u)]});
    });
  }

  void push_all(int most_neighbours) {
    const ClosedMesh& mesh = layout_.mesh;
    for (int v = 0; v < mesh.vertex_slots(); ++v) {
      if (v % kStride == 0) stop_if_cancelled(observer_);
      if (!mesh.has_vertex(v) || v == layout_.surface->apex) continue;
      if (!mesh.has_valence_above(v, most_neighbours)) push_around(v);
    }
  }

  /// Quadric error with a little length, made dearer by high valence and needles. Lengths are of a
  /// surface of area 1. The quadric lets tips of limbs live long, which gives them their share of
  /// the sphere.
  double cost_of(int h) const {
    const ClosedMesh& mesh = layout_.mesh;
    const int u = mesh.from(h), v = mesh.to(h);
    const Vector3d& p = layout_.positions[index(v)];
    const Eigen::Vector4d homogeneous = p.homogeneous();
    const double error =
        std::max(0.0, homogeneous.dot((quadrics_[index(u)] + quadrics_[index(v)]) * homogeneous));
    const double length = (layout_.positions[index(u)] - p).squaredNorm();
    double needle = 0;
    int valence = 0;
    mesh.around(u, [&](int g) {
      ++valence;
      const int a = mesh.to(g), b = mesh.apex(g);
      if (a == v || b == v) return;
      const Vector3d pa = layout_.positions[index(a)] - p, pb = layout_.positions[index(b)] - p;
      const double longest =
          std::max({pa.squaredNorm(), pb.squaredNorm(), (pb - pa).squaredNorm()});
      const double quality = longest > 0 ? pa.cross(pb).norm() / longest : 0;
      needle = std::max(needle, 1 / (quality + 1e-3));
    });
    const int joint_valence = valence + mesh.valence(v) - 4;
    const double crowd = joint_valence > 10 ? 0.3 * (joint_valence - 10) : 0;
    return (error + 1e-5 * length + 1e-9) * (1 + crowd) * (1 + 0.02 * needle) +
           (is_landmark_[index(u)] ? 1e10 : 0);
  }

  bool is_cap(int h) const {
    const ClosedMesh& mesh = layout_.mesh;
    const int apex = layout_.surface->apex;
    return mesh.from(h) == apex || mesh.to(h) == apex || mesh.apex(h) == apex;
  }

  /// A boundary vertex moves along the boundary only, the apex never, and no inner edge may come to
  /// join two boundary vertices.
  bool keeps_boundary(int h) const {
    const ClosedMesh& mesh = layout_.mesh;
    const std::vector<char>& on_boundary = layout_.surface->on_boundary;
    const int u = mesh.from(h), v = mesh.to(h);
    if (layout_.surface->apex < 0) return true;
    if (u == layout_.surface->apex || v == layout_.surface->apex) return false;
    if (on_boundary[index(u)]) return is_cap(h) || is_cap(mesh.opposite(h));
    if (!on_boundary[index(v)]) return true;
    bool keeps = true;
    mesh.around(u, [&](int g) {
      const int w = mesh.to(g);
      if (w != v && on_boundary[index(w)] && mesh.find(v, w) < 0) keeps = false;
    });
    return keeps;
  }

  void collapse(int h) {
    ClosedMesh& mesh = layout_.mesh;
    const int u = mesh.from(h), v = mesh.to(h);
    quadrics_[index(v)] += quadrics_[index(u)];
    std::vector<int> changed;  // the kept vertex is among them
    mesh.around(u, [&](int g) { changed.push_back(mesh.to(g)); });
    layout_.collapses.push_back(mesh.collapse(h));
    for (const int w : changed) {
      if (w == layout_.surface->apex) continue;
      ++stamps_[index(w)];
      if (!mesh.has_valence_above(w, kCrowded)) push_around(w);
    }
  }

  SphereLayout& layout_;
  const CollapseFilter& allowed_;
  const Observer& observer_;
  std::vector<Eigen::Matrix4d> quadrics_;
  std::vector<char> is_landmark_;
  std::vector<int> stamps_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

void coarsen(SphereLayout& layout, int count, const CollapseFilter& allowed,
             const Observer& observer) {
  Coarsening(layout, allowed, observer).run(count);
}

}  // namespace morphbake
