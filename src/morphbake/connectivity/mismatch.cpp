#include "morphbake/connectivity/mismatch.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "morphbake/diagnostics/counted.h"
#include "morphbake/mesh/sides.h"
#include "morphbake/sources/corner_surface.h"

namespace morphbake {
namespace {

constexpr std::size_t kPlaces = 3;  // how many places a message names
constexpr int kBorder = -1, kCrowded = -2, kNoSide = -3;
constexpr int kNone = -1;

constexpr const char* kRemeshHint =
    "give them new triangles that fit all: \"connectivity\": {\"mode\": \"remesh\"}; or export "
    "poses or sculpts of one mesh alike";

/// A welded source: vertices and neighbours of its triangles.
struct Welded {
  Triangles triangles;   ///< welded vertices, in the file's order and winding
  Triangles neighbours;  ///< across side k, from corner k to the next: a triangle, or k... above
};

Welded welded(const SourceMesh& source) {
  const std::vector<int> corners = welded_corners(source);
  Welded surface;
  surface.triangles = Eigen::Map<const Triangles>(corners.data(), source.triangles.rows(), 3);
  surface.neighbours = Triangles::Constant(source.triangles.rows(), 3, kNoSide);
  const std::vector<TriangleSide> sides = sorted_sides(surface.triangles);
  for_each_edge(sides, [&](auto begin, auto end) {
    for (auto side = begin; side != end; ++side) {
      int& across = surface.neighbours(side->triangle, side->corner);
      if (end - begin == 2) {
        across = (side == begin ? begin + 1 : begin)->triangle;
      } else {
        across = end - begin == 1 ? kBorder : kCrowded;
      }
    }
  });
  return surface;
}

/// Which triangle of the other source is a triangle's counterpart: both are the same up to
/// triangle `split`, where one source has a run of triangles that the other lacks.
struct Alignment {
  int split = 0;
  int missing = 0;  ///< triangles that the other source lacks
  int added = 0;    ///< triangles that only the other source has

  int to_other(int f) const {
    if (f < split) return f;
    return f < split + missing ? kNone : f - missing + added;
  }

  int to_first(int g) const {
    if (g < split) return g;
    return g < split + added ? kNone : g - added + missing;
  }
};

bool side_agrees(const Welded& first, const Welded& other, const Alignment& alignment, int f,
                 int k) {
  const int across = first.neighbours(f, k);
  const int there = other.neighbours(alignment.to_other(f), k);
  return across < 0 ? there == across : there == alignment.to_other(across) && there != kNone;
}

bool agrees(const Welded& first, const Welded& other, const Alignment& alignment, int f) {
  if (alignment.to_other(f) == kNone) return false;
  for (int k = 0; k < 3; ++k) {
    if (!side_agrees(first, other, alignment, f, k)) return false;
  }
  return true;
}

/// The alignment by which most triangles agree, of equals the one with the first split.
///
/// Whether a triangle agrees changes with the split only where the split passes it or one of its
/// neighbours; so all splits are judged at once by where the number of agreeing triangles changes.
Alignment best_alignment(const Welded& first, const Welded& other) {
  const auto count = static_cast<int>(first.triangles.rows());
  const auto other_count = static_cast<int>(other.triangles.rows());
  Alignment alignment{count, std::max(0, count - other_count), std::max(0, other_count - count)};
  if (count == other_count) return alignment;
  const int last = count - alignment.missing;  // split
  std::vector<int> change(static_cast<std::size_t>(last) + 2, 0);
  for (int f = 0; f < count; ++f) {
    std::array<int, 9> begins{0};  // of ranges of splits that are alike for this triangle
    std::size_t ranges = 1;
    for (const int t :
         {f, first.neighbours(f, 0), first.neighbours(f, 1), first.neighbours(f, 2)}) {
      for (const int begin : {t + 1 - alignment.missing, t + 1}) {
        if (t >= 0 && begin > 0 && begin <= last) begins[ranges++] = begin;
      }
    }
    std::sort(begins.begin(), begins.begin() + static_cast<std::ptrdiff_t>(ranges));
    bool before = false;
    for (std::size_t i = 0; i < ranges; ++i) {
      alignment.split = begins[i];
      const bool now = agrees(first, other, alignment, f);
      change[static_cast<std::size_t>(begins[i])] +=
          static_cast<int>(now) - static_cast<int>(before);
      before = now;
    }
  }
  int agreeing = 0, best = -1;
  for (int split = 0; split <= last; ++split) {
    agreeing += change[static_cast<std::size_t>(split)];
    if (agreeing <= best) continue;
    best = agreeing;
    alignment.split = split;
  }
  return alignment;
}

/// Marks welded vertices that have several partners in the other source, by triangles that agree.
///
/// @param pairs  a vertex and its partner, of each corner
int count_torn(std::vector<std::array<int, 2>> pairs, std::vector<char>& is_torn) {
  std::sort(pairs.begin(), pairs.end());
  int count = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    if (pairs[i][0] != pairs[i - 1][0] || pairs[i][1] == pairs[i - 1][1]) continue;
    char& mark = is_torn[static_cast<std::size_t>(pairs[i][0])];
    count += mark == 0;
    mark = 1;
  }
  return count;
}

/// Finds what differs between two welded sources.
class Comparison {
 public:
  Comparison(const SourceMesh& first, const SourceMesh& other)
      : first_source_(first),
        other_source_(other),
        first_(welded(first)),
        other_(welded(other)),
        alignment_(best_alignment(first_, other_)) {}

  TopologyMismatch find() {
    mismatch_.first_count = static_cast<int>(first_.triangles.rows());
    mismatch_.other_count = static_cast<int>(other_.triangles.rows());
    find_torn_vertices();
    for (int f = 0; f < mismatch_.first_count; ++f) {
      const int g = alignment_.to_other(f);
      if (g != kNone && !agrees(first_, other_, alignment_, f)) ++mismatch_.other_neighbours;
      if (!is_unlike(f, g)) continue;
      mismatch_.first_triangles.push_back(f);
      add_place(f, g);
    }
    for (int g = 0; g < mismatch_.other_count; ++g) {
      const int f = alignment_.to_first(g);
      if (!is_unlike(f, g)) continue;
      mismatch_.other_triangles.push_back(g);
      if (f == kNone) add_place(f, g);
    }
    return std::move(mismatch_);
  }

 private:
  void find_torn_vertices() {
    std::vector<std::array<int, 2>> pairs, back;
    for (int f = 0; f < mismatch_.first_count; ++f) {
      if (!agrees(first_, other_, alignment_, f)) continue;
      for (int k = 0; k < 3; ++k) {
        const int v = first_.triangles(f, k), w = other_.triangles(alignment_.to_other(f), k);
        pairs.push_back({v, w});
        back.push_back({w, v});
      }
    }
    first_torn_.assign(static_cast<std::size_t>(first_source_.welded_count), 0);
    other_torn_.assign(static_cast<std::size_t>(other_source_.welded_count), 0);
    mismatch_.torn_vertices =
        count_torn(std::move(pairs), first_torn_) + count_torn(std::move(back), other_torn_);
  }

  /// The corner of a pair of triangles that is torn on either side; kNone without.
  int torn_corner(int f, int g) const {
    for (int k = 0; k < 3; ++k) {
      const bool here = f != kNone && first_torn_[static_cast<std::size_t>(first_.triangles(f, k))];
      const bool there =
          g != kNone && other_torn_[static_cast<std::size_t>(other_.triangles(g, k))];
      if (here || there) return k;
    }
    return kNone;
  }

  bool is_unlike(int f, int g) const {
    return f == kNone || g == kNone || !agrees(first_, other_, alignment_, f) ||
           torn_corner(f, g) != kNone;
  }

  MismatchPlace::Spot spot(const SourceMesh& source, int triangle, int f, int g) const {
    const auto at = [&](int k) -> Eigen::RowVector3d {
      return source.positions.row(source.triangles(triangle, k % 3));
    };
    if (f == kNone || g == kNone) return {triangle, (at(0) + at(1) + at(2)) / 3};
    for (int k = 0; k < 3; ++k) {
      if (!side_agrees(first_, other_, alignment_, f, k)) {
        return {triangle, (at(k) + at(k + 1)) / 2};
      }
    }
    return {triangle, at(torn_corner(f, g))};
  }

  void add_place(int f, int g) {
    if (mismatch_.places.size() == kPlaces) return;
    const auto is_near = [](const Welded& surface, int triangle, const auto& spot) {
      if (triangle == kNone || !spot) return false;
      const auto here = surface.triangles.row(triangle),
                 there = surface.triangles.row(spot->triangle);
      return std::any_of(here.begin(), here.end(), [&](int v) {
        return std::find(there.begin(), there.end(), v) != there.end();
      });
    };
    for (const MismatchPlace& place : mismatch_.places) {
      if (is_near(first_, f, place.first) || is_near(other_, g, place.other)) return;
    }
    MismatchPlace& place = mismatch_.places.emplace_back();
    if (f != kNone) place.first = spot(first_source_, f, f, g);
    if (g != kNone) place.other = spot(other_source_, g, f, g);
  }

  const SourceMesh& first_source_;
  const SourceMesh& other_source_;
  Welded first_;
  Welded other_;
  Alignment alignment_;
  std::vector<char> first_torn_;  // one a welded vertex
  std::vector<char> other_torn_;
  TopologyMismatch mismatch_;
};

bool have_same_vertex_order(const SourceMesh& a, const SourceMesh& b) {
  return a.positions.rows() == b.positions.rows() && a.triangles.rows() == b.triangles.rows() &&
         a.triangles == b.triangles;
}

std::string spot_text(const MismatchPlace::Spot& spot, const std::string& source) {
  const Eigen::RowVector3d& at = spot.position;
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) in \"{}\"", at(0), at(1), at(2), source);
}

}  // namespace

TopologyMismatch find_mismatch(const SourceMesh& first, const SourceMesh& other) {
  if (have_same_vertex_order(first, other)) {
    const auto count = static_cast<int>(first.triangles.rows());
    return {count, count, {}, {}, 0, 0, {}};
  }
  return Comparison(first, other).find();
}

Problem mismatch_problem(const SourceMesh& first, const SourceMesh& other,
                         const TopologyMismatch& mismatch) {
  std::vector<std::string> places;
  for (const auto& [here, there] : mismatch.places) {
    if (here && there) {
      places.push_back(spot_text(*here, first.name) + ", " + spot_text(*there, other.name));
    } else {
      places.push_back(here ? spot_text(*here, first.name) + " only"
                            : spot_text(*there, other.name) + " only");
    }
  }
  const bool other_count = mismatch.first_count != mismatch.other_count;
  std::string message;
  if (other_count) {
    message = fmt::format("\"{}\" has {} but \"{}\" has {}", other.name,
                          counted(mismatch.other_count, "triangle", "triangles"), first.name,
                          mismatch.first_count);
  } else {
    std::vector<std::string> parts;
    if (mismatch.other_neighbours > 0) {
      parts.push_back(counted(mismatch.other_neighbours, "triangle has other neighbours",
                              "triangles have other neighbours"));
    }
    if (mismatch.torn_vertices > 0) {
      parts.push_back(counted(mismatch.torn_vertices, "vertex is torn in one of them",
                              "vertices are torn in one of them"));
    }
    message = fmt::format("\"{}\" and \"{}\" are not connected alike: {}", other.name, first.name,
                          fmt::join(parts, " and "));
  }
  message += fmt::format("; first at {}", fmt::join(places, "; "));
  return {Severity::Error,
          other_count ? "connectivity.different-triangles" : "connectivity.different-topology",
          {file_of(other.file), fmt::format("/meshes/{}", other.geometry.mesh), 0, 0},
          std::move(message),
          kRemeshHint};
}

}  // namespace morphbake
