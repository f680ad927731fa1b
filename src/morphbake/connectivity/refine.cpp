#include "morphbake/connectivity/refine.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "morphbake/connectivity/point_distance.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

/// A point this near to a vertex of its triangle, in barycentric coordinates, is not worth another.
constexpr double kAtVertex = 0.9995;
/// A point this near to an edge goes onto it: the triangle beside it would be a needle.
constexpr double kNearEdge = 0.02;

constexpr int kStride = 256;  // vertices or triangles between two looks whether to stop

std::size_t index(int i) { return static_cast<std::size_t>(i); }

double distance_to(const LayeredTriangulation& t, const Layer& layer, int f, const Vector3d& p) {
  const auto corner = [&](int k) -> const Vector3d& {
    return layer.lifted[index(t.mesh.from(3 * f + k))];
  };
  return point_triangle_distance(p, corner(0), corner(1), corner(2)) / layer.atlas.diagonal;
}

/// Locates all source vertices of a layer and calls `each(vertex, triangle, distance)`; boundary
/// vertices have a pass of their own.
template <typename Function>
void for_each_point(const LayeredTriangulation& t, SourcePoints& points, std::size_t s,
                    const Function& each) {
  const Layer& layer = t.layers[s];
  int last = 0;
  while (!t.mesh.has_triangle(last)) ++last;
  int until_look = 0;
  for (const int v : points.order[s]) {
    if (until_look-- == 0) {
      stop_if_cancelled(t.observer);
      until_look = kStride;
    }
    if (layer.atlas.map->on_boundary[index(v)]) continue;
    int& triangle = points.triangle[s][index(v)];
    if (triangle >= 0 && t.mesh.has_triangle(triangle)) last = triangle;
    last = triangle = triangle_over(t, layer, layer.atlas.sphere[index(v)], last);
    each(v, triangle, distance_to(t, layer, triangle, layer.atlas.positions[index(v)]));
  }
}

/// A source vertex that is to be inserted.
struct Candidate {
  double error = 0;
  std::size_t layer = 0;
  int vertex = -1;
};

/// The worst candidate of each triangle.
std::vector<Candidate> worst_points(const LayeredTriangulation& t, SourcePoints& points) {
  std::vector<std::vector<Candidate>> worst(t.layers.size(),
                                            std::vector<Candidate>(index(t.mesh.triangle_slots())));
  tbb::parallel_for(std::size_t{0}, t.layers.size(), [&](std::size_t s) {
    for_each_point(t, points, s, [&](int v, int f, double error) {
      Candidate& candidate = worst[s][index(f)];
      if (error > candidate.error) candidate = {error, s, v};
    });
  });
  for (std::size_t s = 1; s < worst.size(); ++s) {
    for (std::size_t f = 0; f < worst[s].size(); ++f) {
      if (worst[s][f].error > worst[0][f].error) worst[0][f] = worst[s][f];
    }
  }
  return std::move(worst[0]);
}

/// Puts a vertex where a source vertex lies. @return whether there was room
bool insert_point(LayeredTriangulation& t, int f, const Candidate& candidate) {
  if (t.is_cap(f)) return false;
  Layer& layer = t.layers[candidate.layer];
  const Vector3d place = layer.atlas.sphere[index(candidate.vertex)];
  const auto corner = [&](const Layer& of, int k) -> const Vector3d& {
    return of.sphere[index(t.mesh.from(3 * f + k))];
  };
  Vector3d weights = central_weights(place, corner(layer, 0), corner(layer, 1), corner(layer, 2));
  weights /= weights.sum();
  if (weights.maxCoeff() > kAtVertex) return false;
  int smallest = 0;
  const double least = weights.minCoeff(&smallest);
  const int across = 3 * f + (smallest + 1) % 3;  // the edge opposite the smallest share
  Places places;
  int v = -1;
  if (least < kNearEdge && !t.is_boundary_edge(across) && !t.is_hard(across)) {
    const double a = weights((smallest + 1) % 3), b = weights((smallest + 2) % 3);
    if (b < 0.003 * (a + b) || a < 0.003 * (a + b)) return false;
    places = places_on_edge(t, across, b / (a + b));
    places[candidate.layer] = place;
    v = split_edge_at(t, across, places);
  } else {
    places = places_in_triangle(t, f, weights);
    places[candidate.layer] = place;
    v = split_triangle_at(t, f, places);
  }
  if (v < 0) return false;
  lift_onto(layer, v, candidate.vertex);
  return true;
}

/// An edge with what is wrong with it.
struct RatedEdge {
  double rating = 0;
  int a = 0;
  int b = 0;
};

/// Edges whose rating is above `bound`, the worst first; `rate(h)` is called in parallel.
template <typename Function>
std::vector<RatedEdge> edges_above(const LayeredTriangulation& t, double bound,
                                   const Function& rate) {
  std::vector<double> ratings(index(3 * t.mesh.triangle_slots()), 0);
  tbb::parallel_for(0, t.mesh.triangle_slots(), [&](int f) {
    if (f % kStride == 0) stop_if_cancelled(t.observer);
    if (!t.mesh.has_triangle(f)) return;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int a = t.mesh.from(h), b = t.mesh.to(h);
      if (a < b && a != t.apex && b != t.apex) ratings[index(h)] = rate(h);
    }
  });
  std::vector<RatedEdge> rated;
  for (int h = 0; h < static_cast<int>(ratings.size()); ++h) {
    if (ratings[index(h)] > bound)
      rated.push_back({ratings[index(h)], t.mesh.from(h), t.mesh.to(h)});
  }
  std::sort(rated.begin(), rated.end(), [](const RatedEdge& x, const RatedEdge& y) {
    return std::tie(y.rating, x.a, x.b) < std::tie(x.rating, y.a, y.b);
  });
  return rated;
}

Pass split_rated(LayeredTriangulation& t, const std::vector<RatedEdge>& edges, int vertex_limit) {
  Pass pass;
  if (!edges.empty()) pass.error = edges.front().rating;
  for (const RatedEdge& edge : edges) {
    if (t.vertex_count() >= vertex_limit) break;
    const int h = t.mesh.find(edge.a, edge.b);
    if (h >= 0) pass.changes += split_edge_at(t, h, places_on_edge(t, h, 0.5)) >= 0;
  }
  return pass;
}

Vector3d unit_normal(const Layer& layer, int a, int b, int c) {
  return area_normal(layer, a, b, c).normalized();
}

/// How far the sources are from the middle of an edge; of the boundary in full, since it is a
/// curve.
double worst_deviation(const LayeredTriangulation& t, int h) {
  const int a = t.mesh.from(h), b = t.mesh.to(h);
  const int c = t.mesh.apex(h), d = t.mesh.apex(t.mesh.opposite(h));
  const bool is_curve = t.is_boundary_edge(h) || t.is_hard(h);
  double worst = 0;
  for (const Layer& layer : t.layers) {
    const Vector3d direction =
        is_curve ? Vector3d(Vector3d::Zero())
                 : Vector3d(unit_normal(layer, a, b, c) + unit_normal(layer, b, a, d));
    worst = std::max(worst, middle_deviation(layer, a, b, direction));
  }
  return worst;
}

double angle_at(const Vector3d& p, const Vector3d& q, const Vector3d& r) {
  const Vector3d u = q - p, w = r - p;
  return std::atan2(u.cross(w).norm(), u.dot(w));
}

/// How much is gained by turning an edge: summed over the layers, the excess of the opposite angles
/// over two right ones; infinite where the new edge follows the sources much better, negative where
/// it must not be turned.
double flip_gain(const LayeredTriangulation& t, int h, double tolerance) {
  const int a = t.mesh.from(h), b = t.mesh.to(h);
  const int c = t.mesh.apex(h), d = t.mesh.apex(t.mesh.opposite(h));
  double excess = 0, old_deviation = 0, new_deviation = 0;
  for (const Layer& layer : t.layers) {
    const auto at = [&](int v) -> const Vector3d& { return layer.lifted[index(v)]; };
    const Vector3d n1 = area_normal(layer, a, b, c), n2 = area_normal(layer, b, a, d);
    const Vector3d m1 = area_normal(layer, a, d, c), m2 = area_normal(layer, d, b, c);
    const double new_length = m1.norm() * m2.norm();
    if (!(new_length > 1e-28)) return -1;
    const double old_bend = n1.dot(n2) / (n1.norm() * n2.norm() + 1e-300);
    const double new_bend = m1.dot(m2) / new_length;
    if (new_bend < old_bend && new_bend < 0.5) return -1;
    excess += angle_at(at(c), at(a), at(b)) + angle_at(at(d), at(a), at(b)) - std::numbers::pi;
    const double before = middle_deviation(layer, a, b, n1 + n2) / tolerance;
    const double after = middle_deviation(layer, c, d, m1 + m2) / tolerance;
    old_deviation += before * before;
    new_deviation += after * after;
  }
  const double layers = static_cast<double>(t.layers.size());
  if (std::max(old_deviation, new_deviation) <= 0.5) return excess - 0.1 * layers;
  if (new_deviation < 0.6 * old_deviation && excess > -1.2 * layers) return 100;
  return new_deviation <= old_deviation ? excess - 0.15 * layers : -1;
}

}  // namespace

SourcePoints source_points(const LayeredTriangulation& t) {
  SourcePoints points;
  for (const Layer& layer : t.layers) {
    std::vector<int>& order = points.order.emplace_back();
    const SphereAtlas& atlas = layer.atlas;
    points.triangle.emplace_back(atlas.positions.size(), -1);
    std::vector<char> is_seen(atlas.positions.size(), 0);
    std::vector<int> front{0};  // triangles, breadth first
    std::vector<char> is_reached(atlas.normals.size(), 0);
    is_reached[0] = 1;
    for (std::size_t i = 0; i < front.size(); ++i) {
      for (int h = 3 * front[i]; h < 3 * front[i] + 3; ++h) {
        if (!is_seen[index(atlas.from(h))]) order.push_back(atlas.from(h));
        is_seen[index(atlas.from(h))] = 1;
        const int next = atlas.opposite[index(h)] / 3;
        if (atlas.opposite[index(h)] < 0 || is_reached[index(next)]) continue;
        is_reached[index(next)] = 1;
        front.push_back(next);
      }
    }
  }
  return points;
}

Pass insert_worst_points(LayeredTriangulation& t, SourcePoints& points, double tolerance,
                         int vertex_limit) {
  const std::vector<Candidate> worst = worst_points(t, points);
  std::vector<int> order;
  Pass pass;
  for (int f = 0; f < static_cast<int>(worst.size()); ++f) {
    pass.error = std::max(pass.error, worst[index(f)].error);
    if (worst[index(f)].error > tolerance) order.push_back(f);
  }
  std::sort(order.begin(), order.end(), [&](int f, int g) {
    return worst[index(f)].error != worst[index(g)].error
               ? worst[index(f)].error > worst[index(g)].error
               : f < g;
  });
  std::vector<std::array<int, 3>> corners;  // a triangle that an earlier insertion changed is left
  for (const int f : order) {
    corners.push_back({t.mesh.from(3 * f), t.mesh.from(3 * f + 1), t.mesh.from(3 * f + 2)});
  }
  for (std::size_t i = 0; i < order.size() && t.vertex_count() < vertex_limit; ++i) {
    const int f = order[i];
    if (corners[i] !=
        std::array{t.mesh.from(3 * f), t.mesh.from(3 * f + 1), t.mesh.from(3 * f + 2)}) {
      continue;
    }
    pass.changes += insert_point(t, f, worst[index(f)]);
  }
  return pass;
}

std::vector<std::vector<double>> source_errors(const LayeredTriangulation& t,
                                               SourcePoints& points) {
  std::vector<std::vector<double>> errors(t.layers.size());
  tbb::parallel_for(std::size_t{0}, t.layers.size(), [&](std::size_t s) {
    errors[s].assign(t.layers[s].atlas.positions.size(), 0);
    for_each_point(t, points, s, [&](int v, int, double error) { errors[s][index(v)] = error; });
  });
  return errors;
}

Pass insert_boundary_points(LayeredTriangulation& t, double tolerance, int vertex_limit) {
  Pass pass;
  if (t.apex < 0) return pass;
  for (std::size_t s = 0; s < t.layers.size(); ++s) {
    Layer& layer = t.layers[s];
    const auto longitude = [](const Vector3d& x) { return std::atan2(x.y(), x.x()); };
    std::vector<std::pair<double, int>> ring;  // boundary half-edges by where they begin
    t.mesh.around(t.apex, [&](int h) {
      const int edge = ClosedMesh::next(h);  // of the cap, runs against the longitudes
      ring.emplace_back(longitude(layer.sphere[index(t.mesh.to(edge))]), t.mesh.opposite(edge));
    });
    std::sort(ring.begin(), ring.end());
    std::vector<Candidate> worst(ring.size());
    for (int v = 0; v < static_cast<int>(layer.atlas.sphere.size()); ++v) {
      if (!layer.atlas.map->on_boundary[index(v)]) continue;
      const auto after = std::upper_bound(
          ring.begin(), ring.end(), std::pair(longitude(layer.atlas.sphere[index(v)]), 1 << 30));
      const std::size_t i = after == ring.begin()
                                ? ring.size() - 1
                                : static_cast<std::size_t>(after - ring.begin()) - 1;
      const int h = ring[i].second;
      const double error = point_segment_distance(layer.atlas.positions[index(v)],
                                                  layer.lifted[index(t.mesh.from(h))],
                                                  layer.lifted[index(t.mesh.to(h))]) /
                           layer.atlas.diagonal;
      pass.error = std::max(pass.error, error);
      if (error > worst[i].error) worst[i] = {error, s, v};
    }
    std::vector<RatedEdge> edges;
    for (const auto& [from, h] : ring) edges.push_back({0, t.mesh.from(h), t.mesh.to(h)});
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (!(worst[i].error > tolerance) || t.vertex_count() >= vertex_limit) continue;
      const int h = t.mesh.find(edges[i].a, edges[i].b);
      const double begin = longitude(layer.sphere[index(edges[i].a)]);
      const auto away = [&](const Vector3d& x) {
        return std::remainder(longitude(x) - begin, 2 * std::numbers::pi);
      };
      const Vector3d place = layer.atlas.sphere[index(worst[i].vertex)];
      const double fraction = away(place) / away(layer.sphere[index(edges[i].b)]);
      if (!(fraction > kNearEdge && fraction < 1 - kNearEdge)) continue;
      Places places = places_on_edge(t, h, fraction);
      places[s] = place;
      const int v = split_edge_at(t, h, places);
      if (v < 0) continue;
      lift_onto(layer, v, worst[i].vertex);
      ++pass.changes;
    }
  }
  return pass;
}

Pass split_long_edges(LayeredTriangulation& t, double length, int vertex_limit) {
  const auto longest = [&](int h) {
    double most = 0;
    for (const Layer& layer : t.layers) {
      const double here =
          (layer.lifted[index(t.mesh.from(h))] - layer.lifted[index(t.mesh.to(h))]).norm();
      most = std::max(most, here / layer.atlas.diagonal);
    }
    return most;
  };
  return split_rated(t, edges_above(t, length, longest), vertex_limit);
}

Pass split_deviating_edges(LayeredTriangulation& t, double tolerance, int vertex_limit) {
  const auto deviation = [&](int h) { return worst_deviation(t, h); };
  return split_rated(t, edges_above(t, tolerance, deviation), vertex_limit);
}

Pass flip_edges(LayeredTriangulation& t, double tolerance, const Patch& patch) {
  Pass pass;
  const auto gain = [&](int h) {
    const bool is_free = patch.has(t.mesh.from(h)) && patch.has(t.mesh.to(h)) && can_flip(t, h);
    return is_free ? flip_gain(t, h, tolerance) : -1;
  };
  const std::vector<RatedEdge> edges = edges_above(t, 0, gain);
  for (const RatedEdge& edge : edges) {
    const int h = t.mesh.find(edge.a, edge.b);
    if (h < 0 || !can_flip(t, h) || !(flip_gain(t, h, tolerance) > 0)) continue;
    t.mesh.flip(h);
    ++pass.changes;
  }
  return pass;
}

}  // namespace morphbake
