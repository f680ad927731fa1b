#include "morphbake/connectivity/trace_hard_edges.h"

#include <algorithm>
#include <limits>
#include <unordered_set>
#include <vector>

#include "morphbake/correspondence/triangle_energy.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

/// A vertex this near, in shares of an edge or triangle, goes onto the hard edge: beside it the
/// triangles would be needles.
constexpr double kNear = 0.1;
/// A vertex that may not move counts as on the hard edge this near to it.
constexpr double kAt = 1e-9;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Traces the hard edges of one source.
class Tracer {
 public:
  Tracer(LayeredTriangulation& t, std::size_t layer) : t_(t), s_(layer) {
    while (!t_.mesh.has_triangle(last_)) ++last_;
    for (int v = 0; v < t.mesh.vertex_slots(); ++v) {
      if (t.mesh.has_vertex(v) && v != t.apex) note_source_vertex(v);
    }
  }

  /// @return whether there is now a chain of hard edges between two vertices of the source's map
  bool trace(int source_a, int source_b) {
    const int a = vertex_at(source_a), b = vertex_at(source_b);
    if (a < 0 || b < 0) return false;
    constexpr int kMostSteps = 10000;
    int at = a;
    for (int step = 0; step < kMostSteps && at != b; ++step) {
      const int next = step_towards(at, a, b);
      if (next < 0) return false;
      if (!t_.on_boundary[index(at)] || !t_.on_boundary[index(next)]) {
        t_.hard_edges.insert(t_.edge_key(at, next));
      }
      at = next;
    }
    return at == b;
  }

 private:
  Layer& layer() { return t_.layers[s_]; }

  const Vector3d& place(int v) const { return t_.layers[s_].sphere[index(v)]; }

  /// Remembers which vertices lie exactly at vertices of the source.
  void note_source_vertex(int v) {
    const SphereAtlas& atlas = layer().atlas;
    if (vertex_of_source_.empty()) vertex_of_source_.assign(atlas.sphere.size(), -1);
    const int f = layer().triangle[index(v)];
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      if (is_at(v, atlas.corner(h))) {
        vertex_of_source_[index(atlas.from(h))] = v;
      }
    }
  }

  bool is_at(int v, const Vector3d& x) const { return (place(v) - x).squaredNorm() < kAt * kAt; }

  bool is_held(int v) const {
    return t_.is_fixed[index(v)] || t_.on_boundary[index(v)] || is_settled_.count(v) > 0 ||
           t_.is_on_hard_edge(v);
  }

  /// Whether a vertex can lie at `to` in this layer.
  bool has_room(int v, const Vector3d& to) const {
    bool has_room = true;
    t_.mesh.around(v, [&](int h) {
      has_room = has_room && is_positive(to, place(t_.mesh.to(h)), place(t_.mesh.apex(h)));
    });
    return has_room;
  }

  void move(int v, const Vector3d& to) { lift(layer(), v, to, layer().triangle[index(v)]); }

  /// Puts a vertex exactly onto a vertex of the source.
  int settle(int v, int source) {
    lift_onto(layer(), v, source);
    vertex_of_source_[index(source)] = v;
    is_settled_.insert(v);
    return v;
  }

  /// The vertex at a vertex of the source; makes one where there is none. -1: no room
  int vertex_at(int source) {
    const SphereAtlas& atlas = layer().atlas;
    const Vector3d x = atlas.sphere[index(source)];
    if (const int v = vertex_of_source_[index(source)]; v >= 0 && is_at(v, x)) {
      is_settled_.insert(v);
      return v;
    }
    last_ = triangle_over(t_, layer(), x, last_);
    Vector3d weights =
        central_weights(x, place(t_.mesh.from(3 * last_)), place(t_.mesh.from(3 * last_ + 1)),
                        place(t_.mesh.from(3 * last_ + 2)));
    weights /= weights.sum();
    int corner = 0;
    if (!atlas.map->on_boundary[index(source)] && weights.maxCoeff(&corner) > 1 - kNear) {
      const int v = t_.mesh.from(3 * last_ + corner);
      if (!is_held(v) && has_room(v, x)) return settle(v, source);
    }
    const double least = weights.minCoeff(&corner);
    const int across = 3 * last_ + (corner + 1) % 3;
    const double a = weights((corner + 1) % 3), b = weights((corner + 2) % 3);
    const bool is_on_edge = atlas.map->on_boundary[index(source)] ||
                            (least < kNear && !t_.is_boundary_edge(across) && !t_.is_hard(across));
    int v = -1;
    if (is_on_edge) {
      Places places = places_on_edge(t_, across, b / (a + b));
      places[s_] = x;
      v = split_edge_at(t_, across, places);
    }
    if (v < 0 && !t_.is_cap(last_) && !atlas.map->on_boundary[index(source)]) {
      Places places = places_in_triangle(t_, last_, weights);
      places[s_] = x;
      v = split_triangle_at(t_, last_, places);
    }
    return v < 0 ? -1 : settle(v, source);
  }

  /// The next vertex on the arc from `a` to `b`, seen from `at` on it. -1: none
  int step_towards(int at, int a, int b) {
    if (t_.mesh.find(at, b) >= 0) return b;
    const Vector3d normal = place(a).cross(place(b)).normalized();
    int crossed = -1;
    double best = -std::numeric_limits<double>::infinity();
    t_.mesh.around(at, [&](int h) {
      const Vector3d &p = place(t_.mesh.to(h)), &q = place(t_.mesh.apex(h));
      const double right = normal.dot(p), left = normal.dot(q);
      if (right > 0 || left < 0 || right == left) return;
      const double ahead = (q * -right + p * left).normalized().dot(place(b));
      if (ahead <= best) return;
      best = ahead;
      crossed = ClosedMesh::next(h);  // from p to q
    });
    if (crossed < 0 || t_.is_cap(ClosedMesh::triangle_of(crossed)) ||
        t_.is_boundary_edge(crossed)) {
      return -1;
    }
    const int p = t_.mesh.from(crossed), q = t_.mesh.to(crossed);
    const double right = normal.dot(place(p)), left = normal.dot(place(q));
    const double fraction = right / (right - left);
    const Vector3d x = ((1 - fraction) * place(p) + fraction * place(q)).normalized();
    const int near = fraction < 0.5 ? p : q;
    const double from_near = std::min(fraction, 1 - fraction);
    if (from_near < kAt) return near;
    if (from_near < kNear && !is_held(near) && has_room(near, x)) {
      move(near, x);
      return near;
    }
    Places places = places_on_edge(t_, crossed, fraction);
    places[s_] = x;
    return split_edge_at(t_, crossed, places);
  }

  LayeredTriangulation& t_;
  std::size_t s_;
  int last_ = 0;                        ///< triangle where the last search ended
  std::vector<int> vertex_of_source_;   ///< of the map's surface: -1 where none lies; may be old
  std::unordered_set<int> is_settled_;  ///< vertices that have to stay at vertices of the source
};

}  // namespace

int trace_hard_edges(LayeredTriangulation& t, int vertex_limit) {
  int missed = 0;
  for (std::size_t s = 0; s < t.layers.size(); ++s) {
    const std::vector<Eigen::Vector2i>& edges = t.layers[s].atlas.map->hard_edges;
    if (edges.empty()) continue;
    Tracer tracer(t, s);
    for (const Eigen::Vector2i& edge : edges) {
      stop_if_cancelled(t.observer);
      const bool has_place = t.vertex_count() < vertex_limit;
      missed += !(has_place && tracer.trace(edge(0), edge(1)));
    }
  }
  return missed;
}

}  // namespace morphbake
