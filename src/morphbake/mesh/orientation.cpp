#include "morphbake/mesh/orientation.h"

#include <array>

#include "morphbake/mesh/sides.h"

namespace morphbake {
namespace {

constexpr int kNone = -1;

/// What lies across a side of a triangle.
struct Neighbour {
  int triangle = kNone;
  bool runs_alike = false;  ///< along the edge, so that one of both is turned
};

using Neighbours = std::vector<std::array<Neighbour, 3>>;

Neighbours neighbours_of(const Triangles& triangles) {
  Neighbours neighbours(static_cast<std::size_t>(triangles.rows()));
  const std::vector<TriangleSide> sides = sorted_sides(triangles);
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first != 2) return;
    const TriangleSide &x = *first, &y = *(first + 1);
    const bool alike = x.forward == y.forward;
    const auto at = [&](const TriangleSide& side) -> Neighbour& {
      return neighbours[static_cast<std::size_t>(side.triangle)]
                       [static_cast<std::size_t>(side.corner)];
    };
    at(x) = {y.triangle, alike};
    at(y) = {x.triangle, alike};
  });
  return neighbours;
}

struct Piece {
  std::vector<int> triangles;
  bool has_two_sides = true;
};

/// Walks over the piece of a triangle, breadth first, and marks what runs against it.
Piece walk_piece(int seed, const Neighbours& neighbours, std::vector<char>& is_seen,
                 std::vector<char>& is_turned) {
  Piece piece;
  piece.triangles.push_back(seed);
  is_seen[static_cast<std::size_t>(seed)] = 1;
  for (std::size_t i = 0; i < piece.triangles.size(); ++i) {
    const auto f = static_cast<std::size_t>(piece.triangles[i]);
    for (const auto& [neighbour, runs_alike] : neighbours[f]) {
      if (neighbour == kNone) continue;
      const auto g = static_cast<std::size_t>(neighbour);
      const auto turned = static_cast<char>(runs_alike != (is_turned[f] != 0));
      if (is_seen[g] != 0) {
        piece.has_two_sides = piece.has_two_sides && is_turned[g] == turned;
        continue;
      }
      is_seen[g] = 1;
      is_turned[g] = turned;
      piece.triangles.push_back(neighbour);
    }
  }
  return piece;
}

}  // namespace

Orientation find_orientation(const Triangles& triangles) {
  const Neighbours neighbours = neighbours_of(triangles);
  Orientation orientation;
  std::vector<char>& is_turned = orientation.is_turned;
  is_turned.assign(neighbours.size(), 0);
  std::vector<char> is_seen(neighbours.size(), 0);
  for (int seed = 0; seed < triangles.rows(); ++seed) {
    if (is_seen[static_cast<std::size_t>(seed)] != 0) continue;
    const Piece piece = walk_piece(seed, neighbours, is_seen, is_turned);
    std::size_t turned = 0;
    for (const int f : piece.triangles) turned += is_turned[static_cast<std::size_t>(f)] != 0;
    if (!piece.has_two_sides) orientation.twisted_pieces.push_back(seed);
    const bool most_are_turned = 2 * turned > piece.triangles.size();
    for (const int f : piece.triangles) {
      char& mark = is_turned[static_cast<std::size_t>(f)];
      mark = static_cast<char>(piece.has_two_sides && (mark != 0) != most_are_turned);
    }
  }
  return orientation;
}

}  // namespace morphbake
