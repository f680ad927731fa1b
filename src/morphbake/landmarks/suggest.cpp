#include "morphbake/landmarks/suggest.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "morphbake/landmarks/correspondences.h"
#include "morphbake/landmarks/doubts.h"
#include "morphbake/landmarks/surface_places.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/sources/common_landmarks.h"

namespace morphbake {
namespace {

constexpr double kFarthest = 0.15;      // in `reach`: nearer points say nothing new
constexpr double kOnPlane = 0.05;       // in `reach`: is on the mirror plane
constexpr double kStandsOut = 0.5;      // in boxes of half size 1
constexpr double kApartOfSummit = 0.2;  // in `reach`
constexpr double kOnRim = 0.15;         // in `reach`: such a tip is a corner of the rim

/// A tip, or a mirrored pair of tips, that waits to become landmarks.
struct TipUnit {
  double prominence = 0;
  std::vector<std::pair<int, int>> tips;  ///< of a and b; -1 where the shape has none
};

/// How far a tip of a shape stands out; of a pair, the less prominent of both.
double prominence_of(const Side& side, int tip) {
  const int across = side.symmetry.mirrored[static_cast<std::size_t>(tip)];
  const double own = side.sketch.tips[static_cast<std::size_t>(tip)].prominence;
  return across < 0 ? own
                    : std::min(own, side.sketch.tips[static_cast<std::size_t>(across)].prominence);
}

bool is_on_rim(const Side& side, int tip) {
  const Eigen::VectorXd& distance = side.sketch.from_tip[static_cast<std::size_t>(tip)];
  return std::any_of(side.sketch.boundary.begin(), side.sketch.boundary.end(),
                     [&](int vertex) { return distance(vertex) < kOnRim; });
}

/// The matched tips, pairs together, the most prominent first.
std::vector<TipUnit> matched_units(const Side& a, const Side& b, const std::vector<int>& partner) {
  std::vector<TipUnit> units;
  std::vector<char> is_done(partner.size(), 0);
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] < 0 || is_done[i] != 0) continue;
    const auto tip = static_cast<int>(i);
    if (is_on_rim(a, tip) || is_on_rim(b, partner[i])) continue;
    TipUnit unit{(prominence_of(a, tip) + prominence_of(b, partner[i])) / 2, {{tip, partner[i]}}};
    int across = a.symmetry.mirrored[i];
    if (!a.symmetry.found && b.symmetry.found) {
      const int other = b.symmetry.mirrored[static_cast<std::size_t>(partner[i])];
      const auto found = std::find(partner.begin(), partner.end(), other);
      across = other < 0 || found == partner.end() ? -1 : static_cast<int>(found - partner.begin());
    }
    is_done[i] = 1;
    if (across >= 0 && across != tip && partner[static_cast<std::size_t>(across)] >= 0 &&
        is_done[static_cast<std::size_t>(across)] == 0) {
      unit.tips.emplace_back(across, partner[static_cast<std::size_t>(across)]);
      is_done[static_cast<std::size_t>(across)] = 1;
    }
    units.push_back(std::move(unit));
  }
  std::stable_sort(units.begin(), units.end(),
                   [](const TipUnit& x, const TipUnit& y) { return x.prominence > y.prominence; });
  return units;
}

/// Tips that have no partner, of both shapes, the most prominent first.
std::vector<TipUnit> lonely_units(const Side& a, const Side& b, const std::vector<int>& partner) {
  std::vector<TipUnit> units;
  for (std::size_t i = 0; i < partner.size(); ++i) {
    const auto tip = static_cast<int>(i);
    if (partner[i] < 0 && !is_on_rim(a, tip)) units.push_back({prominence_of(a, tip), {{tip, -1}}});
  }
  for (int j = 0; j < static_cast<int>(b.sketch.tips.size()); ++j) {
    const bool has_partner = std::find(partner.begin(), partner.end(), j) != partner.end();
    if (!has_partner && !is_on_rim(b, j)) units.push_back({prominence_of(b, j), {{-1, j}}});
  }
  std::stable_sort(units.begin(), units.end(),
                   [](const TipUnit& x, const TipUnit& y) { return x.prominence > y.prominence; });
  return units;
}

int room(const Correspondences& all, int count) {
  return count - static_cast<int>(all.pairs.size());
}

void add_tips(Correspondences& all, const std::vector<int>& partner, int count) {
  const auto tip_vertex = [](const Side& side, int tip) {
    return side.sketch.tips[static_cast<std::size_t>(tip)].vertex;
  };
  const auto base_vertex = [](const Side& side, int tip) {
    return side.sketch.tips[static_cast<std::size_t>(tip)].base;
  };
  for (const TipUnit& unit : matched_units(all.a, all.b, partner)) {
    if (static_cast<int>(unit.tips.size()) > room(all, count)) continue;
    for (std::size_t i = 0; i < unit.tips.size(); ++i) {
      add_pair(all, tip_vertex(all.a, unit.tips[i].first), tip_vertex(all.b, unit.tips[i].second),
               PairKind::Tip, i > 0);
    }
  }
  for (const TipUnit& unit : lonely_units(all.a, all.b, partner)) {
    const auto [a, b] = unit.tips.front();
    const Side& side = a >= 0 ? all.a : all.b;
    const int tip = a >= 0 ? a : b;
    const int across = side.symmetry.mirrored[static_cast<std::size_t>(tip)];
    Transfer transfer{a >= 0, tip_vertex(side, tip), -1, PairKind::Tip, base_vertex(side, tip), 0};
    transfer.is_middle = across == tip;
    if (across >= 0 && across != tip) {
      transfer.twin = tip_vertex(side, across);
      transfer.twin_base = base_vertex(side, across);
    }
    add_transferred(all, transfer, room(all, count));
  }
}

/// The vertex of the rim that reaches furthest in a direction of the shape's box; where that is no
/// sideways, of those on the mirror plane if the rim crosses it.
int furthest_on_rim(const Side& side, const Eigen::Vector3d& direction) {
  const std::vector<int>& rim = side.sketch.boundary;
  const Eigen::Vector3d sideways = side.frame.axes.transpose() * side.symmetry.sideways;
  const bool is_middle = side.symmetry.is_exact && std::abs(sideways.dot(direction)) < 0.3;
  const auto height = [&](int vertex) {
    return direction.dot(side.frame.in_box(side.position(vertex)));
  };
  int best = -1;
  const auto look = [&](bool on_plane) {
    for (const int vertex : rim) {
      if (on_plane &&
          std::abs(side.symmetry.side_of(side.position(vertex))) > kOnPlane * side.sketch.reach) {
        continue;
      }
      if (best < 0 || height(vertex) > height(best)) best = vertex;
    }
  };
  if (is_middle) look(true);
  if (best < 0) look(false);
  return best;
}

/// The point that stands out most before the rim, as a nose does: the furthest along the axis in
/// which the rim is narrowest.
void add_summit(Correspondences& all, const Eigen::Vector3d& axis) {
  const auto height = [&](const Side& side, int vertex) {
    return axis.dot(side.frame.in_box(side.position(vertex)));
  };
  const auto of_rim = [&](const Side& side) {
    double sum = 0;
    for (const int vertex : side.sketch.boundary) sum += height(side, vertex);
    return sum / static_cast<double>(side.sketch.boundary.size());
  };
  const auto summit = [&](const Side& side, double sign) {
    int best = 0;
    for (int v = 1; v < side.sketch.mesh.positions.rows(); ++v) {
      if (sign * height(side, v) > sign * height(side, best)) best = v;
    }
    return best;
  };
  const double rim_a = of_rim(all.a);
  const int high = summit(all.a, 1), low = summit(all.a, -1);
  const double sign = height(all.a, high) - rim_a >= rim_a - height(all.a, low) ? 1 : -1;
  const int a = sign > 0 ? high : low, b = summit(all.b, sign);
  const bool stands_out = sign * (height(all.a, a) - rim_a) > kStandsOut &&
                          sign * (height(all.b, b) - of_rim(all.b)) > kStandsOut;
  if (!stands_out || all.a.to_landmark(a) < kApartOfSummit ||
      all.b.to_landmark(b) < kApartOfSummit) {
    return;
  }
  add_pair(all, a, b, PairKind::Tip, false);
}

/// Four points of the rims, the furthest along the two axes in which they are widest; and the
/// summit.
void add_rim(Correspondences& all, int count) {
  if (all.a.sketch.boundary.empty() || all.b.sketch.boundary.empty()) return;
  std::array<std::pair<double, int>, 3> widths;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
    const auto at = [&](double sign) {
      const int vertex = furthest_on_rim(all.a, sign * direction);
      return all.a.frame.in_box(all.a.position(vertex))(axis);
    };
    widths[static_cast<std::size_t>(axis)] = {at(-1) - at(1), axis};  // the widest first
  }
  std::sort(widths.begin(), widths.end());
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(widths[i].second);
    const Eigen::Vector3d sideways = all.a.frame.axes.transpose() * all.a.symmetry.sideways;
    const bool is_pair = all.a.symmetry.found && std::abs(sideways.dot(direction)) > 0.7;
    bool has_first = false;
    for (const double sign : {1.0, -1.0}) {
      const int a = furthest_on_rim(all.a, sign * direction);
      const int b = furthest_on_rim(all.b, sign * direction);
      const bool is_new = all.a.to_landmark(a) > kOnRim && all.b.to_landmark(b) > kOnRim;
      if (!is_new || room(all, count) < 1) continue;
      add_pair(all, a, b, PairKind::Rim, is_pair && has_first);
      has_first = true;
    }
  }
  add_summit(all, Eigen::Vector3d::Unit(widths[2].second));
}

/// Points of the first shape that are far from all landmarks, until there are enough.
void add_far_points(Correspondences& all, int count) {
  const Eigen::Index vertices = all.a.sketch.mesh.positions.rows();
  Eigen::VectorXd nearest =
      Eigen::VectorXd::Constant(vertices, std::numeric_limits<double>::infinity());
  std::size_t seen = 0;
  while (room(all, count) > 0) {
    for (; seen < all.a.from_landmark.size(); ++seen) {
      nearest = nearest.cwiseMin(all.a.from_landmark[seen]);
    }
    int next = 0;
    if (all.pairs.empty()) {
      // The top: any first point would do, but this one is found on both shapes.
      all.a.sketch.mesh.positions.col(1).maxCoeff(&next);
      nearest(next) = 0;
    } else if (nearest.maxCoeff(&next) < kFarthest) {
      return;
    }
    // Where a landmark of the other shape is in the way, the next farthest is tried.
    const int twin = all.a.twin(next);
    const Transfer single{true, next, -1, PairKind::Point, next, 0};
    const Transfer pair{true, next, twin, PairKind::Point, next, twin};
    const int added = add_transferred(all, room(all, count) > 1 ? pair : single, room(all, count));
    if (added == 0) nearest(next) = 0;
  }
}

/// Whose sides are called left and right: the shape that looks more along Z.
const Side& reference_side(const Correspondences& all, bool& is_a) {
  const auto clearness = [](const Symmetry& symmetry) {
    return symmetry.found ? std::abs(symmetry.sideways.x()) : -1.0;
  };
  is_a = clearness(all.a.symmetry) >= clearness(all.b.symmetry);
  return is_a ? all.a : all.b;
}

/// Puts the left one of each mirrored pair first.
void sort_sides(Correspondences& all) {
  bool is_a = true;
  const Side& side = reference_side(all, is_a);
  const auto sideways = [&](const VertexPair& pair) {
    return side.symmetry.side_of(side.position(is_a ? pair.a : pair.b));
  };
  for (std::size_t i = 0; i + 1 < all.pairs.size(); ++i) {
    if (all.pairs[i].unit != all.pairs[i + 1].unit) continue;
    if (sideways(all.pairs[i]) >= sideways(all.pairs[i + 1])) continue;
    std::swap(all.pairs[i], all.pairs[i + 1]);
    std::swap(all.a.from_landmark[i], all.a.from_landmark[i + 1]);
    std::swap(all.b.from_landmark[i], all.b.from_landmark[i + 1]);
  }
}

/// "tip_1", "tip_2_left", "tip_2_right"; of pairs, the left one stands first.
std::vector<std::string> names_of_pairs(const std::vector<VertexPair>& pairs) {
  std::map<PairKind, int> numbers;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const bool is_right = i > 0 && pairs[i - 1].unit == pairs[i].unit;
    const bool is_left = i + 1 < pairs.size() && pairs[i + 1].unit == pairs[i].unit;
    const PairKind kind = pairs[i].kind;
    const char* word = kind == PairKind::Tip ? "tip" : kind == PairKind::Rim ? "rim" : "point";
    if (!is_right) ++numbers[kind];
    names.push_back(fmt::format("{}_{}{}", word, numbers[kind],
                                is_left    ? "_left"
                                : is_right ? "_right"
                                           : ""));
  }
  return names;
}

}  // namespace

SuggestedLandmarks suggest_landmarks(const SourceSurface& a, const SourceSurface& b,
                                     const SuggestOptions& options, const Observer& observer) {
  advance(observer, {"landmarks", 0, 4});
  ShapeSketch sketch_a = sketch_shape(a.mesh);
  drop_branches(sketch_a);
  advance(observer, {"landmarks", 1, 4});
  ShapeSketch sketch_b = sketch_shape(b.mesh);
  drop_branches(sketch_b);
  advance(observer, {"landmarks", 2, 4});
  warn_of_pieces(observer, a, sketch_a);
  warn_of_pieces(observer, b, sketch_b);
  warn_of_borders(observer, a, b, sketch_a, sketch_b);
  Alignment kept = align_shapes(sketch_a, sketch_b, Handedness::Kept);
  Correspondences all{Side(sketch_a), Side(sketch_b), {}, 0};
  all.a.frame = kept.a;
  all.b.frame = kept.b;
  warn_of_mirror(observer, a, b, all, kept);
  respect_symmetry(all.a.symmetry, all.b.symmetry, kept.partner);
  match_rest(sketch_a, sketch_b, kept);
  respect_symmetry(all.a.symmetry, all.b.symmetry, kept.partner);
  warn_if_uncertain(observer, a, b, all, kept);
  advance(observer, {"landmarks", 3, 4});

  constexpr int kRimPoints = 4;
  const bool has_rim = !sketch_a.boundary.empty() && !sketch_b.boundary.empty();
  add_rim(all, std::min(kRimPoints, options.count));
  add_tips(all, kept.partner, has_rim ? std::max(options.count, kRimPoints) : options.count);
  add_far_points(all, options.count);
  if (all.pairs.size() < kFewestLandmarks) {
    throw BakeError(Problem{Severity::Error,
                            "landmarks.nothing-found",
                            {b.file, ""},
                            fmt::format("no three points of \"{}\" and \"{}\" can be told to "
                                        "correspond",
                                        a.name, b.name),
                            "write the landmarks by hand: docs/landmarks.md"});
  }
  sort_sides(all);
  std::vector<int> vertices_a, vertices_b;
  std::vector<PairKind> kinds;
  for (const VertexPair& pair : all.pairs) {
    vertices_a.push_back(pair.a);
    vertices_b.push_back(pair.b);
    kinds.push_back(pair.kind);
  }
  SuggestedLandmarks suggested{names_of_pairs(all.pairs),
                               places_on_surface(a.mesh, all.a, vertices_a, kinds),
                               places_on_surface(b.mesh, all.b, vertices_b, kinds)};
  advance(observer, {"landmarks", 4, 4});
  return suggested;
}

}  // namespace morphbake
