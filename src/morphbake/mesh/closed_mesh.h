#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// A collapse that can be taken back: `removed` went into `kept`; `left` and `right` were the third
/// corners of the two triangles at their edge, seen from `removed` towards `kept`.
struct CollapseRecord {
  int removed = 0;
  int kept = 0;
  int left = 0;
  int right = 0;
};

/// A closed oriented triangle surface whose connectivity changes.
///
/// Half-edge 3 f + k runs from corner k of triangle f to corner k + 1. Triangles that die leave
/// holes, which new ones fill; vertices keep their numbers for ever. Not CGAL's Surface_mesh,
/// because a collapse has to be taken back exactly and because headers stay free of CGAL.
/// Invariant: every half-edge has an opposite; a living vertex's triangles form one fan.
class ClosedMesh {
 public:
  /// @param triangles  closed, oriented, manifold
  ClosedMesh(const Triangles& triangles, int vertex_count);

  int vertex_slots() const { return static_cast<int>(outgoing_.size()); }

  int triangle_slots() const { return static_cast<int>(from_.size() / 3); }

  int vertex_count() const { return vertex_count_; }

  bool has_vertex(int v) const { return outgoing_[index(v)] >= 0; }

  bool has_triangle(int f) const { return from_[index(3 * f)] >= 0; }

  static int triangle_of(int h) { return h / 3; }

  static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }

  static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }

  int opposite(int h) const { return opposite_[index(h)]; }

  int from(int h) const { return from_[index(h)]; }

  int to(int h) const { return from_[index(next(h))]; }

  /// The corner of the half-edge's triangle that it does not touch.
  int apex(int h) const { return from_[index(previous(h))]; }

  int outgoing(int v) const { return outgoing_[index(v)]; }

  /// The half-edge that leaves the same vertex, one further counter-clockwise.
  int turn(int h) const { return opposite(previous(h)); }

  /// Calls `each(h)` for every half-edge that leaves v, counter-clockwise.
  template <typename Function>
  void around(int v, const Function& each) const {
    const int first = outgoing(v);
    int h = first;
    do {
      each(h);
      h = turn(h);
    } while (h != first);
  }

  int valence(int v) const;
  /// Whether v has more than `count` neighbours, at no more cost than counting so far.
  bool has_valence_above(int v, int count) const;
  /// The half-edge from a to b, -1 without one.
  int find(int a, int b) const;

  /// Puts a new vertex into a triangle, or on an edge. @return the vertex
  int split_triangle(int f);
  int split_edge(int h);

  /// Whether turning the edge leaves a surface without double edges.
  bool can_flip(int h) const;
  /// Replaces the edge by the one between the two apices; `h` is that edge afterwards.
  void flip(int h);

  /// Whether from(h) can go into to(h): the two share exactly two neighbours.
  bool can_collapse(int h) const;
  CollapseRecord collapse(int h);
  void undo(const CollapseRecord& record);

  /// The living triangles, in the order of their slots.
  Triangles triangles() const;

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  int add_vertex();
  int add_triangle(int a, int b, int c);
  void remove_triangle(int f);
  void pair(int g, int h);

  std::vector<int> from_;      ///< 3 #slots: -1 in dead triangles
  std::vector<int> opposite_;  ///< 3 #slots
  std::vector<int> outgoing_;  ///< #V: -1 of dead vertices
  std::vector<int> free_triangles_;
  int vertex_count_ = 0;
};

}  // namespace morphbake
