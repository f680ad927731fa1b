#include "morphbake/atlas/pack_charts.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/convex_hull_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace morphbake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;

constexpr int kScaleSteps = 14;       // of a bisection
constexpr double kFirstShare = 0.95;  // of the square: no packing is denser
constexpr int kPlaces = 512;          // places tried along the skyline, at least

std::vector<Eigen::Vector2d> hull_of(const PicturePlaces& places) {
  std::vector<Kernel::Point_2> points, hull;
  for (const auto place : places.rowwise()) points.emplace_back(place(0), place(1));
  CGAL::convex_hull_2(points.begin(), points.end(), std::back_inserter(hull));
  std::vector<Eigen::Vector2d> corners;
  for (const Kernel::Point_2& point : hull) corners.emplace_back(point.x(), point.y());
  return corners;
}

/// Turns the chart so that its box of least area stands upright, its corner at the origin. One side
/// of that box lies along an edge of the convex hull (Freeman and Shapira 1975).
void stand_upright(FlatChart& chart) {
  const std::vector<Eigen::Vector2d> hull = hull_of(chart.places);
  double least = std::numeric_limits<double>::infinity();
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    if (edge.norm() == 0) continue;
    const Eigen::Vector2d x = edge.normalized(), y(-x.y(), x.x());
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d high = -low;
    for (const Eigen::Vector2d& corner : hull) {
      const Eigen::Vector2d at(x.dot(corner), y.dot(corner));
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
    const Eigen::Vector2d extent = high - low;
    if (extent.prod() >= least) continue;
    least = extent.prod();
    if (extent.x() <= extent.y()) {
      turn << x.transpose(), y.transpose();
    } else {
      turn << -y.transpose(), x.transpose();
    }
  }
  chart.places = (chart.places * turn.transpose()).eval();
  const Eigen::RowVector2d corner = chart.places.colwise().minCoeff();
  chart.places.rowwise() -= corner;
}

/// The border of a chart in its box, whose corner is the origin.
struct Piece {
  std::vector<std::array<Eigen::RowVector2d, 2>> border;
  Eigen::RowVector2d extent;
};

Piece piece_of(const FlatChart& chart) {
  std::set<std::array<int, 2>> sides;
  for (std::size_t c = 0; c < chart.of_corner.size(); ++c) {
    const std::size_t next = c % 3 == 2 ? c - 2 : c + 1;
    const int a = chart.of_corner[c], b = chart.of_corner[next];
    if (sides.erase({b, a}) == 0) sides.insert({a, b});
  }
  Piece piece{{}, chart.places.colwise().maxCoeff()};
  for (const auto& [a, b] : sides)
    piece.border.push_back({chart.places.row(a), chart.places.row(b)});
  return piece;
}

/// A place of a box turned a quarter to the left.
Eigen::RowVector2d quarter_turned(const Eigen::RowVector2d& place,
                                  const Eigen::RowVector2d& extent) {
  return {extent.y() - place.y(), place.x()};
}

Piece quarter_turned(const Piece& piece) {
  Piece turned{piece.border, {piece.extent.y(), piece.extent.x()}};
  for (auto& side : turned.border) {
    for (Eigen::RowVector2d& end : side) end = quarter_turned(end, piece.extent);
  }
  return turned;
}

/// What a chart takes of each column of texels, with its padding. Rows count from its own corner.
struct Outline {
  std::vector<int> low;   ///< one a column: first row taken
  std::vector<int> high;  ///< and the row after the last
  int height = 0;

  int width() const { return static_cast<int>(low.size()); }
};

/// Takes what lies within `padding` texels of the points of one column of texels.
void take(Outline& outline, int column, double y0, double y1, int padding) {
  const int low = static_cast<int>(std::floor(std::min(y0, y1)));
  const int high = static_cast<int>(std::floor(std::max(y0, y1))) + 1 + 2 * padding;
  for (int i = column; i <= column + 2 * padding; ++i) {
    const auto at = static_cast<std::size_t>(i);
    outline.low[at] = std::min(outline.low[at], low);
    outline.high[at] = std::max(outline.high[at], high);
  }
  outline.height = std::max(outline.height, high);
}

/// Takes an edge, column by column.
void take_edge(Outline& outline, Eigen::RowVector2d a, Eigen::RowVector2d b, int padding) {
  if (a.x() > b.x()) std::swap(a, b);
  const int first = static_cast<int>(std::floor(a.x())), last = static_cast<int>(std::floor(b.x()));
  const double slope = first < last ? (b.y() - a.y()) / (b.x() - a.x()) : 0;
  double y = a.y();
  for (int column = first; column < last; ++column) {
    const double next = a.y() + slope * (column + 1 - a.x());
    take(outline, column, y, next, padding);
    y = next;
  }
  take(outline, last, y, b.y(), padding);
}

Outline outline_of(const Piece& piece, double scale, int padding) {
  Outline outline;
  const auto width = static_cast<std::size_t>(std::floor(piece.extent.x() * scale)) + 1;
  outline.low.assign(width + 2 * static_cast<std::size_t>(padding),
                     std::numeric_limits<int>::max());
  outline.high.assign(outline.low.size(), 0);
  for (const auto& [a, b] : piece.border) {
    take_edge(outline, a * scale, b * scale, padding);
  }
  return outline;
}

/// Where a piece goes.
struct Spot {
  double cost = std::numeric_limits<double>::infinity();
  int column = 0;
  int row = 0;
  int turns = 0;  ///< quarters to the left
};

/// How charts are laid out.
struct Strategy {
  int padding = 0;
  double rise = 0;  ///< cost of a row higher, in rows of the mean side that are left empty below
  std::vector<std::size_t> order;  ///< of charts
};

/// The spot on the skyline that leaves the least below the outline and ends lowest; of the highest
/// cost when there is no room.
Spot best_spot(const Outline& outline, double rise, const std::vector<int>& skyline) {
  const int size = static_cast<int>(skyline.size());
  const int step = std::max(1, size / kPlaces);
  const double side = rise * std::sqrt(static_cast<double>(outline.width()) * outline.height);
  Spot best;
  for (int column = 0; column + outline.width() <= size; column += step) {
    const int* top = skyline.data() + column;
    int row = 0;
    std::int64_t below = 0;
    for (int i = 0; i < outline.width(); ++i) {
      const int low = outline.low[static_cast<std::size_t>(i)];
      row = std::max(row, top[i] - low);
      below += low - top[i];
    }
    if (row + outline.height > size) continue;
    below += std::int64_t{row} * outline.width();
    const double cost = static_cast<double>(below) + (row + outline.height) * side;
    if (cost < best.cost) best = {cost, column, row, 0};
  }
  return best;
}

/// A piece in its four directions.
using Turns = std::array<Piece, 4>;

Turns turns_of(const FlatChart& chart) {
  Turns turns{piece_of(chart), {}, {}, {}};
  for (std::size_t i = 1; i < turns.size(); ++i) turns[i] = quarter_turned(turns[i - 1]);
  return turns;
}

/// Puts a piece where it costs least; false without room.
bool put(const Turns& turns, double scale, const Strategy& strategy, std::vector<int>& skyline,
         Spot& spot) {
  spot = {};
  Outline taken;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    Outline outline = outline_of(turns[i], scale, strategy.padding);
    Spot found = best_spot(outline, strategy.rise, skyline);
    if (found.cost >= spot.cost) continue;
    found.turns = static_cast<int>(i);
    spot = found;
    taken = std::move(outline);
  }
  if (taken.width() == 0) return false;
  std::transform(taken.high.begin(), taken.high.end(), skyline.begin() + spot.column,
                 [&](int high) { return spot.row + high; });
  return true;
}

/// Where all pieces go at one scale.
struct Layout {
  double scale = 0;
  std::vector<Spot> spots;  ///< one a piece; none while there is no layout
};

/// Lays out all pieces at `scale`; leaves `layout` alone when one finds no room.
bool lay_out(const std::vector<Turns>& pieces, double scale, int size, const Strategy& strategy,
             Layout& layout) {
  std::vector<int> skyline(static_cast<std::size_t>(size), 0);
  std::vector<Spot> spots(pieces.size());
  for (const std::size_t i : strategy.order) {
    if (!put(pieces[i], scale, strategy, skyline, spots[i])) return false;
  }
  layout = {scale, std::move(spots)};
  return true;
}

/// The charts by falling `key`.
template <typename Key>
std::vector<std::size_t> falling(const std::vector<FlatChart>& charts, const Key& key) {
  std::vector<double> keys;
  for (const FlatChart& chart : charts) {
    const Eigen::RowVector2d extent = chart.places.colwise().maxCoeff();
    keys.push_back(key(extent));
  }
  std::vector<std::size_t> order(charts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return keys[a] > keys[b]; });
  return order;
}

/// No one order and no one weight is best for all surfaces: these differ by a fifth of the square
/// in what they fill, and all four take less than a second.
std::vector<Strategy> strategies_for(const std::vector<FlatChart>& charts, int padding) {
  const auto longest = [](const Eigen::RowVector2d& extent) { return extent.maxCoeff(); };
  const auto largest = [](const Eigen::RowVector2d& extent) { return extent.prod(); };
  std::vector<Strategy> strategies;
  for (const auto& order : {falling(charts, longest), falling(charts, largest)}) {
    for (const double rise : {0.3, 1.0}) strategies.push_back({padding, rise, order});
  }
  return strategies;
}

/// Turns the chart as its spot says and moves it there.
void move_to(const Spot& spot, double scale, int size, int padding, FlatChart& chart) {
  Eigen::RowVector2d extent = chart.places.colwise().maxCoeff();
  for (int i = 0; i < spot.turns; ++i) {
    for (auto place : chart.places.rowwise()) place = quarter_turned(place, extent);
    std::swap(extent.x(), extent.y());
  }
  chart.places *= scale;
  chart.places.col(0).array() += spot.column + padding;
  chart.places.col(1).array() = size - (spot.row + padding + chart.places.col(1).array());
}

double area_of(const FlatChart& chart) {
  double area = 0;
  for (std::size_t c = 0; c < chart.of_corner.size(); c += 3) {
    const auto place = [&](std::size_t k) { return chart.places.row(chart.of_corner[c + k]); };
    const Eigen::RowVector2d a = place(1) - place(0), b = place(2) - place(0);
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return area;
}

}  // namespace

double pack_charts(std::vector<FlatChart>& charts, int size, int padding,
                   const Observer& observer) {
  double area = 0;
  for (FlatChart& chart : charts) {
    stand_upright(chart);
    area += area_of(chart);
  }
  std::vector<Turns> pieces;
  for (const FlatChart& chart : charts) pieces.push_back(turns_of(chart));
  const double full = area > 0 ? size * std::sqrt(kFirstShare / area) : 0;
  Layout best;
  for (const Strategy& strategy : strategies_for(charts, padding)) {
    double step = (full - best.scale) / 2;
    if (best.spots.empty() && !lay_out(pieces, 0, size, strategy, best)) continue;
    for (int i = 0; i < kScaleSteps; ++i, step /= 2) {
      stop_if_cancelled(observer);
      lay_out(pieces, best.scale + step, size, strategy, best);
    }
  }
  for (std::size_t i = 0; i < best.spots.size(); ++i) {
    move_to(best.spots[i], best.scale, size, padding, charts[i]);
  }
  return best.scale;
}

}  // namespace morphbake
