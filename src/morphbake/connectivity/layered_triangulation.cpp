#include "morphbake/connectivity/layered_triangulation.h"

#include <cmath>

#include "morphbake/correspondence/triangle_energy.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

bool is_positive_in(const Layer& layer, const Vector3d& place, int a, int b) {
  return is_positive(place, layer.sphere[index(a)], layer.sphere[index(b)]);
}

void append_vertex(LayeredTriangulation& t, bool on_boundary) {
  t.is_fixed.push_back(0);
  t.on_boundary.push_back(on_boundary);
}

/// A triangle of the layer's atlas near a triangulation's edge or triangle, to start a walk.
void append_places(LayeredTriangulation& t, const Places& places, int neighbour) {
  for (std::size_t s = 0; s < t.layers.size(); ++s) {
    Layer& layer = t.layers[s];
    layer.sphere.emplace_back();
    layer.lifted.emplace_back();
    layer.triangle.push_back(0);
    lift(layer, static_cast<int>(layer.sphere.size()) - 1, places[s],
         layer.triangle[index(neighbour)]);
  }
}

}  // namespace

bool is_positive_everywhere(const LayeredTriangulation& t, int a, int b, int c) {
  for (const Layer& layer : t.layers) {
    if (!is_positive_in(layer, layer.sphere[index(a)], b, c)) return false;
  }
  return true;
}

void lift(Layer& layer, int vertex, const Vector3d& place, int near_triangle) {
  const int f = layer.atlas.locate(place, near_triangle);
  layer.sphere[index(vertex)] = place;
  layer.triangle[index(vertex)] = f;
  layer.lifted[index(vertex)] = layer.atlas.position(f, layer.atlas.weights_at(place, f));
}

void lift_onto(Layer& layer, int vertex, int source_vertex) {
  layer.sphere[index(vertex)] = layer.atlas.sphere[index(source_vertex)];
  layer.triangle[index(vertex)] = layer.atlas.triangle_of_vertex[index(source_vertex)];
  layer.lifted[index(vertex)] = layer.atlas.positions[index(source_vertex)];
}

int triangle_below(const Layer& layer, int a, int b, int c) {
  const Vector3d middle =
      (layer.sphere[index(a)] + layer.sphere[index(b)] + layer.sphere[index(c)]).normalized();
  return layer.atlas.locate(middle, layer.triangle[index(a)]);
}

Vector3d normal_below(const Layer& layer, int a, int b, int c) {
  return layer.atlas.normals[index(triangle_below(layer, a, b, c))];
}

double middle_deviation(const Layer& layer, int a, int b, const Vector3d& direction) {
  const Vector3d place = (layer.sphere[index(a)] + layer.sphere[index(b)]).normalized();
  const int f = layer.atlas.locate(place, layer.triangle[index(a)]);
  const Vector3d away = layer.atlas.position(f, layer.atlas.weights_at(place, f)) -
                        0.5 * (layer.lifted[index(a)] + layer.lifted[index(b)]);
  const double length = direction.norm();
  const double distance = length > 0 ? std::abs(away.dot(direction)) / length : away.norm();
  return distance / layer.atlas.diagonal;
}

Places places_on_edge(const LayeredTriangulation& t, int h, double fraction) {
  Places places;
  for (const Layer& layer : t.layers) {
    places.push_back(((1 - fraction) * layer.sphere[index(t.mesh.from(h))] +
                      fraction * layer.sphere[index(t.mesh.to(h))])
                         .normalized());
  }
  return places;
}

Places places_in_triangle(const LayeredTriangulation& t, int f, const Vector3d& weights) {
  Places places;
  for (const Layer& layer : t.layers) {
    Vector3d place = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) place += weights(k) * layer.sphere[index(t.mesh.from(3 * f + k))];
    places.push_back(place.normalized());
  }
  return places;
}

int triangle_over(const LayeredTriangulation& t, const Layer& layer, const Vector3d& x, int start) {
  const auto corner = [&](int h) -> const Vector3d& { return layer.sphere[index(t.mesh.from(h))]; };
  const auto opposite = [&](int h) { return t.mesh.opposite(h); };
  if (start >= 0 && t.mesh.has_triangle(start) && x.dot(corner(3 * start)) > 0) {
    const int found = walk_to(x, start, 2000, corner, opposite);
    if (found >= 0) return found;
  }
  const auto is_there = [&](int f) { return t.mesh.has_triangle(f); };
  return search_triangle(x, t.mesh.triangle_slots(), is_there, corner);
}

std::vector<int> surface_triangles(const LayeredTriangulation& t) {
  std::vector<int> slots;
  for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
    if (t.mesh.has_triangle(f) && !t.is_cap(f)) slots.push_back(f);
  }
  return slots;
}

Mesh lifted_mesh(const LayeredTriangulation& t, const Layer& layer, const std::vector<int>& slots) {
  Mesh mesh{Positions(t.mesh.vertex_slots(), 3),
            Triangles(static_cast<Eigen::Index>(slots.size()), 3)};
  for (int v = 0; v < t.mesh.vertex_slots(); ++v) mesh.positions.row(v) = layer.lifted[index(v)];
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      mesh.triangles(static_cast<Eigen::Index>(i), k) = t.mesh.from(3 * slots[i] + k);
    }
  }
  return mesh;
}

int split_edge_at(LayeredTriangulation& t, int h, const Places& places) {
  const int a = t.mesh.from(h), b = t.mesh.to(h);
  const int c = t.mesh.apex(h), d = t.mesh.apex(t.mesh.opposite(h));
  if (a == t.apex || b == t.apex) return -1;
  for (std::size_t s = 0; s < places.size(); ++s) {
    const Layer& layer = t.layers[s];
    if (!is_positive_in(layer, places[s], b, c) || !is_positive_in(layer, places[s], c, a) ||
        !is_positive_in(layer, places[s], a, d) || !is_positive_in(layer, places[s], d, b)) {
      return -1;
    }
  }
  const bool on_boundary = t.is_boundary_edge(h);
  const bool is_hard = t.hard_edges.erase(t.edge_key(a, b)) > 0;
  const int v = t.mesh.split_edge(h);
  append_vertex(t, on_boundary);
  append_places(t, places, a);
  if (is_hard) t.hard_edges.insert({t.edge_key(a, v), t.edge_key(v, b)});
  return v;
}

int split_triangle_at(LayeredTriangulation& t, int f, const Places& places) {
  const int a = t.mesh.from(3 * f), b = t.mesh.from(3 * f + 1), c = t.mesh.from(3 * f + 2);
  for (std::size_t s = 0; s < places.size(); ++s) {
    const Layer& layer = t.layers[s];
    if (!is_positive_in(layer, places[s], a, b) || !is_positive_in(layer, places[s], b, c) ||
        !is_positive_in(layer, places[s], c, a)) {
      return -1;
    }
  }
  const int v = t.mesh.split_triangle(f);
  append_vertex(t, false);
  append_places(t, places, a);
  return v;
}

bool can_flip(const LayeredTriangulation& t, int h) {
  const int o = t.mesh.opposite(h);
  if (t.is_cap(ClosedMesh::triangle_of(h)) || t.is_cap(ClosedMesh::triangle_of(o))) return false;
  if (t.is_hard(h) || !t.mesh.can_flip(h)) return false;
  const int a = t.mesh.from(h), b = t.mesh.to(h), c = t.mesh.apex(h), d = t.mesh.apex(o);
  // No inner edge may join two boundary vertices: the sphere could not tell it from the boundary.
  if (t.on_boundary[index(c)] && t.on_boundary[index(d)]) return false;
  return is_positive_everywhere(t, a, d, c) && is_positive_everywhere(t, d, b, c);
}

bool can_collapse(const LayeredTriangulation& t, int h) {
  const int u = t.mesh.from(h), v = t.mesh.to(h);
  if (t.is_fixed[index(u)] || v == t.apex || u == t.apex) return false;
  if (t.on_boundary[index(u)] && !t.is_boundary_edge(h)) return false;
  int hard = 0;
  bool allowed = true;
  t.mesh.around(u, [&](int g) {
    const int a = t.mesh.to(g), b = t.mesh.apex(g);
    hard += t.is_hard(g);
    if (!t.on_boundary[index(u)] && t.on_boundary[index(v)] && a != v && t.on_boundary[index(a)] &&
        t.mesh.find(v, a) < 0) {
      allowed = false;
    }
    if (allowed && a != v && b != v) allowed = is_positive_everywhere(t, v, a, b);
  });
  // What lies on a hard edge may only slide along it.
  if (hard != 0 && (hard != 2 || !t.is_hard(h))) return false;
  return allowed && t.mesh.can_collapse(h);
}

void collapse(LayeredTriangulation& t, int h) {
  const int u = t.mesh.from(h), v = t.mesh.to(h);
  std::vector<int> hard;
  t.mesh.around(u, [&](int g) {
    if (t.hard_edges.erase(t.edge_key(u, t.mesh.to(g))) > 0 && t.mesh.to(g) != v) {
      hard.push_back(t.mesh.to(g));
    }
  });
  t.mesh.collapse(h);
  for (const int w : hard) t.hard_edges.insert(t.edge_key(v, w));
}

}  // namespace morphbake
