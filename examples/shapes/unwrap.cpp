// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap.h"

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace shapes {
namespace {

namespace flattening = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Simple_cartesian<double>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Neighbours = std::vector<std::array<int, 3>>;

/// The triangles across the three edges of each triangle of a closed surface.
Neighbours neighbours_of(const Rows3i& triangles) {
  std::map<std::pair<int, int>, int> owner;
  const auto edge = [&](Eigen::Index f, int k) {
    return std::pair(triangles(f, k), triangles(f, (k + 1) % 3));
  };
  for (Eigen::Index f = 0; f < triangles.rows(); ++f)
    for (int k = 0; k < 3; ++k) owner[edge(f, k)] = static_cast<int>(f);
  Neighbours neighbours(static_cast<std::size_t>(triangles.rows()));
  for (Eigen::Index f = 0; f < triangles.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = edge(f, k);
      neighbours[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)] = owner.at({b, a});
    }
  return neighbours;
}

/// Triangles between two others of one label take it: seams become short, islands vanish.
void straighten(const Neighbours& neighbours, std::vector<int>& labels) {
  for (int round = 0; round < 20; ++round)
    for (std::size_t f = 0; f < labels.size(); ++f) {
      std::array<int, 3> around;
      for (std::size_t k = 0; k < 3; ++k)
        around[k] = labels[static_cast<std::size_t>(neighbours[f][k])];
      std::sort(around.begin(), around.end());
      if (around[0] == around[1] || around[1] == around[2]) labels[f] = around[1];
    }
}

/// Connected pieces of one label, each a list of triangles.
std::vector<std::vector<int>> pieces_of(const Neighbours& neighbours,
                                        const std::vector<int>& labels) {
  std::vector<std::vector<int>> pieces;
  std::vector<bool> is_seen(labels.size(), false);
  for (std::size_t seed = 0; seed < labels.size(); ++seed) {
    if (is_seen[seed]) continue;
    std::vector<int>& piece = pieces.emplace_back(1, static_cast<int>(seed));
    is_seen[seed] = true;
    for (std::size_t i = 0; i < piece.size(); ++i)
      for (const int next : neighbours[static_cast<std::size_t>(piece[i])]) {
        const auto n = static_cast<std::size_t>(next);
        if (is_seen[n] || labels[n] != labels[seed]) continue;
        is_seen[n] = true;
        piece.push_back(next);
      }
  }
  return pieces;
}

/// Pieces too small for a chart of their own take the label that they border on most.
void dissolve_islands(const Neighbours& neighbours, std::vector<int>& labels) {
  constexpr std::size_t fewest = 60;  // triangles
  for (const std::vector<int>& piece : pieces_of(neighbours, labels)) {
    if (piece.size() >= fewest) continue;
    std::map<int, int> borders;
    const int own = labels[static_cast<std::size_t>(piece.front())];
    for (const int f : piece)
      for (const int n : neighbours[static_cast<std::size_t>(f)]) {
        const int label = labels[static_cast<std::size_t>(n)];
        if (label != own) ++borders[label];
      }
    if (borders.empty()) continue;
    const auto most = std::max_element(borders.begin(), borders.end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    for (const int f : piece) labels[static_cast<std::size_t>(f)] = most->first;
  }
}

/// One piece laid flat: a row a corner, y up, in metres.
struct Chart {
  std::vector<int> triangles;
  Rows2d corners;
};

/// Turned so that what is up in space is up in the picture.
void stand_upright(const Mesh& mesh, Chart& chart) {
  const Eigen::RowVector2d centre = chart.corners.colwise().mean();
  Eigen::RowVector2d up(0, 1e-9);
  for (Eigen::Index c = 0; c < chart.corners.rows(); ++c) {
    const int f = chart.triangles[static_cast<std::size_t>(c / 3)];
    up += mesh.positions(mesh.triangles(f, c % 3), 1) * (chart.corners.row(c) - centre);
  }
  up.normalize();
  Eigen::Matrix2d turn;
  turn << up.y(), up.x(), -up.x(), up.y();
  chart.corners = (chart.corners * turn).eval();
  const Eigen::RowVector2d low = chart.corners.colwise().minCoeff();
  chart.corners.rowwise() -= low;
}

double signed_area(const Rows2d& corners, Eigen::Index f) {
  const Eigen::RowVector2d a = corners.row(3 * f + 1) - corners.row(3 * f);
  const Eigen::RowVector2d b = corners.row(3 * f + 2) - corners.row(3 * f);
  return (a.x() * b.y() - a.y() * b.x()) / 2;
}

Chart flattened(const Mesh& mesh, const std::vector<int>& piece) {
  SurfaceMesh surface;
  std::map<int, SurfaceMesh::Vertex_index> index;
  for (const int f : piece) {
    std::array<SurfaceMesh::Vertex_index, 3> corner;
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(f, k);
      const auto [entry, is_new] = index.try_emplace(v);
      const auto p = mesh.positions.row(v);
      if (is_new) entry->second = surface.add_vertex({p[0], p[1], p[2]});
      corner[static_cast<std::size_t>(k)] = entry->second;
    }
    if (surface.add_face(corner[0], corner[1], corner[2]) == SurfaceMesh::null_face())
      throw std::runtime_error("a chart is pinched");
  }
  const auto uv = surface.add_property_map<SurfaceMesh::Vertex_index, Kernel::Point_2>().first;
  const auto border = CGAL::Polygon_mesh_processing::longest_border(surface).first;
  flattening::ARAP_parameterizer_3<SurfaceMesh> method;
  const auto error = flattening::parameterize(surface, method, border, uv);
  if (error != flattening::OK) throw std::runtime_error(flattening::get_error_message(error));
  Chart chart{piece, Rows2d(3 * static_cast<Eigen::Index>(piece.size()), 2)};
  double flat_area = 0;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto& p = uv[index.at(mesh.triangles(piece[i], k))];
      chart.corners.row(3 * static_cast<Eigen::Index>(i) + k) << p.x(), p.y();
    }
    flat_area += signed_area(chart.corners, static_cast<Eigen::Index>(i));
  }
  const double area = CGAL::to_double(CGAL::Polygon_mesh_processing::area(surface));
  chart.corners *= std::sqrt(area / flat_area);
  stand_upright(mesh, chart);
  return chart;
}

/// Where the charts' lower left corners go on shelves of the given width.
/// @return the height that the shelves take
double shelve(const std::vector<Chart>& charts, double width, double margin,
              std::vector<Eigen::RowVector2d>& places) {
  std::vector<std::size_t> order(charts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto extent = [&](std::size_t i) -> Eigen::RowVector2d {
    return charts[i].corners.colwise().maxCoeff().array() + margin;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return extent(a).y() > extent(b).y(); });
  places.assign(charts.size(), {0, 0});
  Eigen::RowVector2d at(margin, margin);
  double shelf = 0;
  for (const std::size_t i : order) {
    if (at.x() + extent(i).x() > width) at = {margin, at.y() + shelf};
    if (at.x() == margin) shelf = extent(i).y();
    places[i] = at;
    at.x() += extent(i).x();
  }
  return at.y() + shelf;
}

/// All charts at one scale, as large as shelves let them be, with room for the paint between them.
void pack(const std::vector<Chart>& charts, Unwrapped& result) {
  constexpr double gap = 1.0 / 128;
  std::vector<Eigen::RowVector2d> places;
  double too_narrow = 0;
  double side = 0.01;
  for (const Chart& chart : charts) side = std::max(side, chart.corners.maxCoeff());
  while (shelve(charts, side, gap * side, places) > side) side *= 1.1;
  for (int i = 0; i < 30; ++i) {
    const double middle = (too_narrow + side) / 2;
    (shelve(charts, middle, gap * middle, places) > middle ? too_narrow : side) = middle;
  }
  shelve(charts, side, gap * side, places);
  for (std::size_t i = 0; i < charts.size(); ++i)
    for (Eigen::Index c = 0; c < charts[i].corners.rows(); ++c) {
      const int f = charts[i].triangles[static_cast<std::size_t>(c / 3)];
      const Eigen::RowVector2d at = (charts[i].corners.row(c) + places[i]) / side;
      result.uv.row(3 * f + c % 3) << at.x(), 1 - at.y();
      result.charts[static_cast<std::size_t>(f)] = static_cast<int>(i);
    }
}

}  // namespace

Unwrapped unwrap(const Mesh& mesh, const std::vector<int>& labels) {
  const Neighbours neighbours = neighbours_of(mesh.triangles);
  std::vector<int> cut = labels;
  straighten(neighbours, cut);
  dissolve_islands(neighbours, cut);
  straighten(neighbours, cut);
  std::vector<Chart> charts;
  for (const std::vector<int>& piece : pieces_of(neighbours, cut))
    charts.push_back(flattened(mesh, piece));
  Unwrapped result{std::vector<int>(labels.size()), Rows2d::Zero(3 * mesh.triangles.rows(), 2)};
  pack(charts, result);
  return result;
}

}  // namespace shapes
