#include "morphbake/derive/mirror.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "morphbake/derive/direction.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

constexpr double kSnap = 1e-6;      ///< of the diagonal
constexpr double kFarthest = 0.02;  ///< of the diagonal
constexpr double kFarCell = 1e15;
constexpr int kCandidateLimit = 16;  ///< vertices at one place that are looked at

Positions reflect(const Positions& positions, const MirrorPlane& plane) {
  const double length = plane.normal.norm();
  const Eigen::Vector3d normal = unit_direction(plane.normal, "normal of the mirror plane");
  const Eigen::VectorXd sides = (positions * normal).array() - plane.offset / length;
  return positions - 2 * sides * normal.transpose();
}

/// Vertices by cells of a grid, for finding those near a point.
class VertexGrid {
 public:
  using Cell = std::array<std::int64_t, 3>;

  VertexGrid(const Positions& positions, double radius) : positions_(positions), radius_(radius) {
    for (int v = 0; v < positions.rows(); ++v) cells_.emplace_back(cell_of(positions.row(v)), v);
    std::sort(cells_.begin(), cells_.end());
  }

  /// Up to kCandidateLimit a cell.
  std::vector<int> near(const Eigen::RowVector3d& point) const {
    std::vector<int> found;
    const Cell low = cell_of(point.array() - radius_), high = cell_of(point.array() + radius_);
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) add_near(point, {x, y, z}, found);
      }
    }
    return found;
  }

 private:
  Cell cell_of(const Eigen::RowVector3d& point) const {
    // Twice the radius: a ball meets at most eight cells. Far away all cells are one, and empty.
    const Eigen::RowVector3d scaled = ((point - positions_.row(0)) / (2 * radius_))
                                          .array()
                                          .floor()
                                          .cwiseMax(-kFarCell)
                                          .cwiseMin(kFarCell);
    return {static_cast<std::int64_t>(scaled(0)), static_cast<std::int64_t>(scaled(1)),
            static_cast<std::int64_t>(scaled(2))};
  }

  void add_near(const Eigen::RowVector3d& point, const Cell& cell, std::vector<int>& found) const {
    auto entry = std::lower_bound(cells_.begin(), cells_.end(), std::pair(cell, 0));
    for (int i = 0; i < kCandidateLimit && entry != cells_.end() && entry->first == cell;
         ++i, ++entry) {
      if ((positions_.row(entry->second) - point).norm() <= radius_) found.push_back(entry->second);
    }
  }

  const Positions& positions_;
  double radius_;
  std::vector<std::pair<Cell, int>> cells_;
};

/// How badly the neighbours of `vertex`, seen across, fit the neighbours of `candidate`.
double misfit(const OneRings& rings, const Positions& reference, const Positions& across,
              int vertex, int candidate) {
  double sum = 0;
  const auto v = static_cast<std::size_t>(vertex), c = static_cast<std::size_t>(candidate);
  for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
    const int neighbour = rings.neighbours[static_cast<std::size_t>(n)];
    double nearest = std::numeric_limits<double>::infinity();
    for (int m = rings.offsets[c]; m < rings.offsets[c + 1]; ++m) {
      const int other = rings.neighbours[static_cast<std::size_t>(m)];
      nearest = std::min(nearest, (across.row(neighbour) - reference.row(other)).norm());
    }
    sum += nearest;
  }
  return sum;
}

/// The vertex of the reference across from each vertex, or -1 where none is near enough.
std::vector<int> vertices_across(const Mesh& reference, const Positions& across, double radius) {
  const OneRings rings =
      one_rings({static_cast<int>(reference.positions.rows()), reference.triangles});
  std::vector<int> partners;
  const VertexGrid grid(reference.positions, radius);
  for (int v = 0; v < across.rows(); ++v) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    const std::vector<int> candidates = grid.near(across.row(v));
    for (const int candidate : candidates) {
      const double value =
          candidates.size() == 1 ? 0 : misfit(rings, reference.positions, across, v, candidate);
      if (best >= 0 && value >= least) continue;
      best = candidate;
      least = value;
    }
    partners.push_back(best);
  }
  return partners;
}

[[noreturn]] void fail(int vertex, double distance, double diagonal) {
  throw BakeError(Problem{
      Severity::Error,
      "derive.not-symmetric",
      {},
      fmt::format("the mirror image of vertex {} lies {:.3g} from the surface: {:.2g} % of the "
                  "diagonal, of which {:.0f} % are allowed",
                  vertex, distance, 100 * distance / diagonal, 100 * kFarthest),
      "give a plane of symmetry, or a symmetric source of the same connectivity as reference"});
}

}  // namespace

Positions mirrored(const Mesh& mesh, const MirrorPlane& plane, const Positions& reference,
                   const Observer& observer) {
  assert(reference.rows() == mesh.positions.rows());
  const Positions image = reflect(mesh.positions, plane);
  const Mesh surface{reference, mesh.triangles};
  const double diagonal = bounding_diagonal(reference);
  // Without any extent all vertices are one point, and each is its own partner.
  if (!(diagonal > 0) || mesh.triangles.rows() == 0) return image;
  const Positions across = reflect(reference, plane);
  if (!across.allFinite()) fail(0, std::numeric_limits<double>::infinity(), diagonal);
  const std::vector<int> partners = vertices_across(surface, across, kSnap * diagonal);
  std::vector<int> strays;
  for (int v = 0; v < across.rows(); ++v) {
    if (partners[static_cast<std::size_t>(v)] < 0) strays.push_back(v);
  }
  const std::vector<SurfacePoint> points =
      closest_points(surface, across(strays, Eigen::all), observer);
  Positions result(image.rows(), 3);
  int worst = -1;
  double farthest = 0;
  for (int v = 0; v < result.rows(); ++v) {
    if (partners[static_cast<std::size_t>(v)] >= 0) {
      result.row(v) = image.row(partners[static_cast<std::size_t>(v)]);
    }
  }
  const Mesh mirrored_mesh{image, mesh.triangles};
  for (std::size_t k = 0; k < strays.size(); ++k) {
    result.row(strays[k]) = position_of(mirrored_mesh, points[k]).transpose();
    const double distance =
        (position_of(surface, points[k]).transpose() - across.row(strays[k])).norm();
    if (!(distance <= farthest)) {
      farthest = distance;
      worst = strays[k];
    }
  }
  if (!(farthest <= kFarthest * diagonal)) fail(worst, farthest, diagonal);
  return result;
}

Positions mirrored(const Mesh& mesh, const MirrorPlane& plane, const Observer& observer) {
  return mirrored(mesh, plane, mesh.positions, observer);
}

}  // namespace morphbake
