#include "morphbake/mesh/closed_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace morphbake {

ClosedMesh::ClosedMesh(const Triangles& triangles, int vertex_count)
    : from_(triangles.data(), triangles.data() + triangles.size()),
      opposite_(from_.size(), -1),
      outgoing_(index(vertex_count), -1) {
  std::vector<std::array<int, 3>> edges;  // smaller end, larger end, half-edge
  edges.reserve(from_.size());
  for (int h = 0; h < static_cast<int>(from_.size()); ++h) {
    edges.push_back({std::min(from(h), to(h)), std::max(from(h), to(h)), h});
    outgoing_[index(from(h))] = h;
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 0; e + 1 < edges.size(); e += 2) {
    assert(edges[e][0] == edges[e + 1][0] && edges[e][1] == edges[e + 1][1]);
    pair(edges[e][2], edges[e + 1][2]);
  }
  vertex_count_ = static_cast<int>(
      std::count_if(outgoing_.begin(), outgoing_.end(), [](int h) { return h >= 0; }));
}

int ClosedMesh::valence(int v) const {
  int count = 0;
  around(v, [&](int) { ++count; });
  return count;
}

bool ClosedMesh::has_valence_above(int v, int count) const {
  const int first = outgoing(v);
  int h = first;
  for (int i = 0; i < count; ++i) {
    h = turn(h);
    if (h == first) return false;
  }
  return true;
}

int ClosedMesh::find(int a, int b) const {
  const int first = outgoing(a);
  if (first < 0) return -1;
  int h = first;
  do {
    if (to(h) == b) return h;
    h = turn(h);
  } while (h != first);
  return -1;
}

int ClosedMesh::add_vertex() {
  outgoing_.push_back(-1);
  ++vertex_count_;
  return vertex_slots() - 1;
}

int ClosedMesh::add_triangle(int a, int b, int c) {
  int f = triangle_slots();
  if (free_triangles_.empty()) {
    from_.resize(from_.size() + 3);
    opposite_.resize(from_.size(), -1);
  } else {
    f = free_triangles_.back();
    free_triangles_.pop_back();
  }
  const std::array corners{a, b, c};
  for (int k = 0; k < 3; ++k) {
    from_[index(3 * f + k)] = corners[index(k)];
    outgoing_[index(corners[index(k)])] = 3 * f + k;
  }
  return f;
}

void ClosedMesh::remove_triangle(int f) {
  for (int k = 0; k < 3; ++k) from_[index(3 * f + k)] = -1;
  free_triangles_.push_back(f);
}

void ClosedMesh::pair(int g, int h) {
  opposite_[index(g)] = h;
  opposite_[index(h)] = g;
}

int ClosedMesh::split_triangle(int f) {
  const int a = from(3 * f), b = from(3 * f + 1), c = from(3 * f + 2);
  const int outer_b = opposite(3 * f + 1), outer_c = opposite(3 * f + 2);
  const int v = add_vertex();
  const int g = add_triangle(b, c, v), e = add_triangle(c, a, v);
  from_[index(3 * f + 2)] = v;  // (a, b, v)
  outgoing_[index(v)] = 3 * f + 2;
  pair(3 * g, outer_b);
  pair(3 * e, outer_c);
  pair(3 * f + 1, 3 * g + 2);
  pair(3 * g + 1, 3 * e + 2);
  pair(3 * e + 1, 3 * f + 2);
  return v;
}

int ClosedMesh::split_edge(int h) {
  const int o = opposite(h);
  const int b = to(h), c = apex(h), d = apex(o);
  const int outer_bc = opposite(next(h)), outer_db = opposite(previous(o));
  const int v = add_vertex();
  // (a, b, c) becomes (a, v, c) and (v, b, c); (b, a, d) becomes (v, a, d) and (b, v, d).
  from_[index(next(h))] = v;
  from_[index(o)] = v;
  const int f = add_triangle(v, b, c), g = add_triangle(b, v, d);
  outgoing_[index(v)] = o;
  pair(3 * f, 3 * g);
  pair(3 * f + 1, outer_bc);
  pair(3 * f + 2, next(h));
  pair(3 * g + 1, previous(o));
  pair(3 * g + 2, outer_db);
  return v;
}

bool ClosedMesh::can_flip(int h) const {
  const int o = opposite(h);
  const int c = apex(h), d = apex(o);
  return c != d && find(c, d) < 0 && valence(from(h)) > 3 && valence(to(h)) > 3;
}

void ClosedMesh::flip(int h) {
  const int o = opposite(h);
  const int a = from(h), b = to(h), c = apex(h), d = apex(o);
  const int bc = opposite(next(h)), ca = opposite(previous(h));
  const int ad = opposite(next(o)), db = opposite(previous(o));
  // (a, b, c), (b, a, d) become (d, c, a) in h's triangle and (c, d, b) in o's.
  const auto write = [&](int first, int x, int y, int z) {
    const std::array corners{x, y, z};
    for (int k = 0; k < 3; ++k, first = next(first)) {
      from_[index(first)] = corners[index(k)];
      outgoing_[index(corners[index(k)])] = first;
    }
  };
  write(h, d, c, a);
  write(o, c, d, b);
  pair(h, o);
  pair(next(h), ca);
  pair(previous(h), ad);
  pair(next(o), db);
  pair(previous(o), bc);
}

bool ClosedMesh::can_collapse(int h) const {
  const int u = from(h), v = to(h);
  const int left = apex(h), right = apex(opposite(h));
  if (vertex_count_ <= 4 || valence(left) <= 3 || valence(right) <= 3) return false;
  int shared = 0;
  around(u, [&](int g) { shared += to(g) != v && find(v, to(g)) >= 0; });
  return shared == 2;
}

CollapseRecord ClosedMesh::collapse(int h) {
  const int o = opposite(h);
  const CollapseRecord record{from(h), to(h), apex(h), apex(o)};
  const auto [u, v, left, right] = record;
  std::vector<int> leaving;
  around(u, [&](int g) { leaving.push_back(g); });
  for (const int g : leaving) from_[index(g)] = v;
  // The sides of the two dying triangles come together.
  const int to_left = opposite(previous(h)), from_left = opposite(next(h));
  const int from_right = opposite(next(o)), to_right = opposite(previous(o));
  pair(to_left, from_left);
  pair(from_right, to_right);
  outgoing_[index(v)] = to_left;
  outgoing_[index(left)] = from_left;
  outgoing_[index(right)] = from_right;
  outgoing_[index(u)] = -1;
  --vertex_count_;
  remove_triangle(triangle_of(h));
  remove_triangle(triangle_of(o));
  return record;
}

void ClosedMesh::undo(const CollapseRecord& record) {
  const auto [u, v, left, right] = record;
  const int to_left = find(v, left), to_right = find(v, right);
  assert(to_left >= 0 && to_right >= 0 && !has_vertex(u));
  const int from_left = opposite(to_left), from_right = opposite(to_right);
  for (int h = to_left; h != to_right;) {
    const int following = turn(h);
    from_[index(h)] = u;
    h = following;
  }
  ++vertex_count_;
  const int f = add_triangle(u, v, left), g = add_triangle(v, u, right);
  outgoing_[index(u)] = 3 * f;
  outgoing_[index(v)] = 3 * g;
  pair(3 * f, 3 * g);
  pair(3 * f + 1, from_left);
  pair(3 * f + 2, to_left);
  pair(3 * g + 1, from_right);
  pair(3 * g + 2, to_right);
}

Triangles ClosedMesh::triangles() const {
  Triangles living(triangle_slots() - static_cast<int>(free_triangles_.size()), 3);
  int row = 0;
  for (int f = 0; f < triangle_slots(); ++f) {
    if (!has_triangle(f)) continue;
    living.row(row++) << from(3 * f), from(3 * f + 1), from(3 * f + 2);
  }
  return living;
}

}  // namespace morphbake
