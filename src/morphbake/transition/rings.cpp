#include "morphbake/transition/rings.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <set>
#include <span>
#include <utility>

#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/sides.h"
#include "morphbake/mesh/surface_point.h"

namespace morphbake {
namespace {

struct Loop {
  std::string name;  ///< "inner", for messages
  std::vector<int> vertices;
};

/// A vertex that a loop goes through.
struct Waypoint {
  int vertex = 0;
  Eigen::VectorXd distances;  ///< #V: from it; 0 where edges alone count
};

using Edge = std::pair<int, int>;  // smaller vertex first

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class RingFinder {
 public:
  RingFinder(const Mesh& mesh, Location where)
      : mesh_(mesh),
        where_(std::move(where)),
        rings_(one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles})),
        components_(connected_components(rings_)) {
    join_triangles();
  }

  /// The vertices nearest to a loop's points.
  std::vector<int> corners(const char* name, const PointSet& points) const {
    std::vector<int> corners;
    for (const SurfacePoint& at : points) {
      const int vertex = nearest_corner(mesh_, at);
      if (corners.empty() || corners.back() != vertex) corners.push_back(vertex);
    }
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (corners.size() < 3) {
      fail(name, fmt::format("its points lie at {} vertices; a loop needs three", corners.size()),
           "set them further apart, or refine the mesh there");
    }
    return corners;
  }

  /// Vertices with the distances that tell what lies between them.
  std::vector<Waypoint> waypoints(const std::vector<int>& vertices,
                                  GeodesicDistances* geodesics) const {
    std::vector<Waypoint> found;
    for (const int v : vertices) {
      found.push_back({v, geodesics != nullptr ? geodesics->from_vertices({v})
                                               : Eigen::VectorXd::Zero(mesh_.positions.rows())});
    }
    return found;
  }

  Loop loop(const char* name, std::span<const Waypoint> waypoints) const {
    Loop loop{name, {}};
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      const std::vector<int> path =
          shortest_path(waypoints[i], waypoints[(i + 1) % waypoints.size()]);
      if (path.empty()) fail(name, "its points lie on different pieces", "keep to one piece");
      loop.vertices.insert(loop.vertices.end(), path.begin(), path.end() - 1);
    }
    check_simple(loop);
    return loop;
  }

  void check_apart(const Loop& inner, const Loop& outer) const {
    if (!is_connected(inner.vertices.front(), outer.vertices.front())) {
      fail("outer", "it lies on another piece than the inner loop", "keep to one piece");
    }
    const std::set<int> first(inner.vertices.begin(), inner.vertices.end());
    for (const int vertex : outer.vertices) {
      if (!first.contains(vertex)) continue;
      fail("outer", fmt::format("it meets the inner loop at {}", shown(vertex)),
           "set the loops further apart, so that they do not cross");
    }
  }

  /// Whether each vertex lies on `loop` or is cut off by it from `other`.
  std::vector<bool> cut_off(const Loop& loop, const Loop& other) const {
    std::set<Edge> cut;
    for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
      cut.insert(edge_of(loop.vertices[i], loop.vertices[(i + 1) % loop.vertices.size()]));
    }
    const std::vector<bool> whole = reach(loop.vertices.front(), {});
    const std::vector<bool> side = reach(other.vertices.front(), cut);
    if (whole == side) {
      fail(loop.name, "it does not cut anything off",
           "a loop around a handle, or along a border, has no inside");
    }
    std::vector<bool> kept(static_cast<std::size_t>(mesh_.positions.rows()), false);
    for (const int vertex : loop.vertices) kept[static_cast<std::size_t>(vertex)] = true;
    for (Eigen::Index f = 0; f < mesh_.triangles.rows(); ++f) {
      if (!whole[static_cast<std::size_t>(f)] || side[static_cast<std::size_t>(f)]) continue;
      for (int k = 0; k < 3; ++k) kept[static_cast<std::size_t>(mesh_.triangles(f, k))] = true;
    }
    return kept;
  }

  bool is_connected(int a, int b) const {
    const std::vector<int>& label = components_.label;
    return label[static_cast<std::size_t>(a)] == label[static_cast<std::size_t>(b)];
  }

 private:
  std::string shown(int vertex) const {
    const auto p = mesh_.positions.row(vertex);
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", p(0), p(1), p(2));
  }

  [[noreturn]] void fail(const std::string& loop, const std::string& message,
                         const std::string& hint) const {
    throw BakeError(Problem{Severity::Error,
                            "recipe.ring",
                            {where_.file, where_.pointer + "/" + loop, 0, 0},
                            fmt::format("the {} loop is no ring: {}", loop, message),
                            hint});
  }

  void check_simple(const Loop& loop) const {
    std::vector<int> sorted = loop.vertices;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice == sorted.end()) return;
    fail(loop.name, fmt::format("it meets itself at {}", shown(*twice)),
         "give its points in the order in which they go round, with more points where it strays");
  }

  bool is_before(int a, int b) const {
    const auto p = mesh_.positions.row(a), q = mesh_.positions.row(b);
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  }

  /// How much longer ways count at each vertex, so that they keep to the geodesic: along the edges
  /// of a regular mesh many ways are nearly as short, far apart. By the detour over the vertex.
  static Eigen::VectorXd detours(const Waypoint& from, const Waypoint& to) {
    constexpr double kWeight = 10;
    const double length = from.distances(to.vertex);
    if (!(length > 0) || !std::isfinite(length)) {
      return Eigen::VectorXd::Ones(from.distances.size());
    }
    const Eigen::ArrayXd detour = (from.distances + to.distances).array() - length;
    return 1 + kWeight * (detour / length).max(0).min(1);
  }

  /// Vertices from `from` to `to`, or none. Of paths of one length the same is taken however
  /// vertices are numbered.
  std::vector<int> shortest_path(const Waypoint& first, const Waypoint& last) const {
    const int from = first.vertex, to = last.vertex;
    const Eigen::VectorXd detour = detours(first, last);
    std::vector<double> length(static_cast<std::size_t>(mesh_.positions.rows()),
                               std::numeric_limits<double>::infinity());
    std::vector<int> before(length.size(), -1);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    length[static_cast<std::size_t>(from)] = 0;
    front.emplace(0, from);
    while (!front.empty()) {
      const auto [so_far, vertex] = front.top();
      front.pop();
      const auto v = static_cast<std::size_t>(vertex);
      if (so_far > length[v]) continue;
      if (so_far > length[static_cast<std::size_t>(to)]) break;
      for (int n = rings_.offsets[v]; n < rings_.offsets[v + 1]; ++n) {
        const int neighbour = rings_.neighbours[static_cast<std::size_t>(n)];
        const auto j = static_cast<std::size_t>(neighbour);
        const double sum =
            so_far + (detour(neighbour) + detour(vertex)) / 2 *
                         (mesh_.positions.row(neighbour) - mesh_.positions.row(vertex)).norm();
        // A way grows at each step, or ways between vertices at one place would lead to each other.
        const bool is_tie =
            sum == length[j] && sum > so_far && before[j] >= 0 && is_before(vertex, before[j]);
        if (sum < length[j]) front.emplace(sum, neighbour);
        if (sum < length[j] || is_tie) before[j] = vertex;
        length[j] = std::min(length[j], sum);
      }
    }
    if (before[static_cast<std::size_t>(to)] < 0) return {};
    std::vector<int> path = {to};
    while (path.back() != from) path.push_back(before[static_cast<std::size_t>(path.back())]);
    std::reverse(path.begin(), path.end());
    return path;
  }

  /// Triangles that are connected with those around `vertex` over edges that are not cut.
  std::vector<bool> reach(int vertex, const std::set<Edge>& cut) const {
    std::vector<bool> reached(static_cast<std::size_t>(mesh_.triangles.rows()), false);
    std::vector<int> open;
    const auto visit = [&](int triangle) {
      if (triangle < 0 || reached[static_cast<std::size_t>(triangle)]) return;
      reached[static_cast<std::size_t>(triangle)] = true;
      open.push_back(triangle);
    };
    for (int f = 0; f < mesh_.triangles.rows(); ++f) {
      for (int k = 0; k < 3; ++k) {
        if (mesh_.triangles(f, k) == vertex) visit(f);
      }
    }
    while (!open.empty()) {
      const int triangle = open.back();
      open.pop_back();
      for (int k = 0; k < 3; ++k) {
        const Edge edge =
            edge_of(mesh_.triangles(triangle, k), mesh_.triangles(triangle, (k + 1) % 3));
        if (!cut.contains(edge)) {
          visit(across_[3 * static_cast<std::size_t>(triangle) + static_cast<std::size_t>(k)]);
        }
      }
    }
    return reached;
  }

  /// The triangle across each edge, -1 at borders.
  void join_triangles() {
    across_.assign(static_cast<std::size_t>(mesh_.triangles.size()), -1);
    const auto corner = [](const TriangleSide& side) {
      return 3 * static_cast<std::size_t>(side.triangle) + static_cast<std::size_t>(side.corner);
    };
    for_each_edge(sorted_sides(mesh_.triangles), [&](auto first, auto last) {
      if (last - first != 2) return;
      across_[corner(first[0])] = first[1].triangle;
      across_[corner(first[1])] = first[0].triangle;
    });
  }

  const Mesh& mesh_;
  Location where_;
  OneRings rings_;
  Components components_;
  std::vector<int> across_;  // 3 #F
};

}  // namespace

Rings find_rings(const Mesh& mesh, const PointSet& inner, const PointSet& outer,
                 GeodesicDistances* geodesics, const Location& where) {
  const RingFinder finder(mesh, where);
  std::vector<int> corners = finder.corners("inner", inner);
  const std::size_t inner_count = corners.size();
  const std::vector<int> outer_corners = finder.corners("outer", outer);
  corners.insert(corners.end(), outer_corners.begin(), outer_corners.end());
  const std::vector<Waypoint> waypoints = finder.waypoints(corners, geodesics);
  const std::span<const Waypoint> all(waypoints);
  const Loop inner_loop = finder.loop("inner", all.first(inner_count));
  const Loop outer_loop = finder.loop("outer", all.subspan(inner_count));
  finder.check_apart(inner_loop, outer_loop);
  Rings rings{inner_loop.vertices, outer_loop.vertices, {}, {}};
  rings.is_inside = finder.cut_off(inner_loop, outer_loop);
  rings.is_outside = finder.cut_off(outer_loop, inner_loop);
  for (std::size_t v = 0; v < rings.is_outside.size(); ++v) {
    const bool is_elsewhere = !finder.is_connected(static_cast<int>(v), rings.inner.front());
    rings.is_outside[v] = rings.is_outside[v] || is_elsewhere;
  }
  return rings;
}

Eigen::VectorXd ring_distance(const Rings& rings, const Eigen::VectorXd& from_inner,
                              const Eigen::VectorXd& from_outer) {
  Eigen::VectorXd d(from_inner.size());
  for (Eigen::Index v = 0; v < d.size(); ++v) {
    const auto vertex = static_cast<std::size_t>(v);
    const double sum = from_inner(v) + from_outer(v);
    d(v) = rings.is_inside[vertex]    ? 0
           : rings.is_outside[vertex] ? 1
           : sum > 0                  ? from_inner(v) / sum
                                      : 0.5;
  }
  return d;
}

Eigen::VectorXd flood_order(const Eigen::VectorXd& distances, const Positions& positions,
                            double softness) {
  const double farthest = distances.size() == 0 ? 0 : distances.maxCoeff();
  if (softness > 0) return farthest > 0 ? (distances / farthest).eval() : distances;
  std::vector<int> rank(static_cast<std::size_t>(distances.size()));
  for (std::size_t v = 0; v < rank.size(); ++v) rank[v] = static_cast<int>(v);
  std::sort(rank.begin(), rank.end(), [&](int a, int b) {
    if (distances(a) != distances(b)) return distances(a) < distances(b);
    const auto p = positions.row(a), q = positions.row(b);
    if (p != q) return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
    return a < b;
  });
  Eigen::VectorXd order(distances.size());
  for (std::size_t i = 0; i < rank.size(); ++i) {
    order(rank[i]) = static_cast<double>(i) / static_cast<double>(rank.size());
  }
  return order;
}

}  // namespace morphbake
