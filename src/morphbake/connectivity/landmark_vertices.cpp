#include "morphbake/connectivity/landmark_vertices.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <utility>

#include "morphbake/mesh/closest_point.h"

namespace morphbake {
namespace {

/// Closer to an edge or a vertex than this, in barycentric coordinates, a point lies on it: a
/// thinner triangle could not be told from one without area.
constexpr double kOnEdge = 1e-9;

/// A triangle list in the making.
struct Draft {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> origin;  ///< triangle of the surface in which each lies
  std::set<std::pair<int, int>> hard_edges;

  const Eigen::Vector3d& position(int vertex) const {
    return positions[static_cast<std::size_t>(vertex)];
  }
};

std::pair<int, int> edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

Draft draft_of(const SourceSurface& surface) {
  Draft draft;
  for (int v = 0; v < surface.mesh.positions.rows(); ++v) {
    draft.positions.emplace_back(surface.mesh.positions.row(v));
  }
  for (int f = 0; f < surface.mesh.triangles.rows(); ++f) {
    draft.triangles.emplace_back(surface.mesh.triangles.row(f));
    draft.origin.push_back(f);
  }
  for (const Eigen::Vector2i& edge : surface.hard_edges) {
    draft.hard_edges.insert(edge_of(edge(0), edge(1)));
  }
  return draft;
}

Eigen::Vector3d barycentric(const Draft& draft, const Eigen::Vector3i& triangle,
                            const Eigen::Vector3d& point) {
  const Eigen::Vector3d& a = draft.position(triangle(0));
  const Eigen::Vector3d& b = draft.position(triangle(1));
  const Eigen::Vector3d& c = draft.position(triangle(2));
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  return Eigen::Vector3d(normal.dot((c - b).cross(point - b)), normal.dot((a - c).cross(point - c)),
                         normal.dot((b - a).cross(point - a))) /
         normal.squaredNorm();
}

/// The part of a triangle of the surface in which a point of that triangle lies most clearly.
std::size_t part_with(const Draft& draft, int origin, const Eigen::Vector3d& point) {
  std::size_t best = draft.triangles.size();
  double best_share = 0;
  for (std::size_t f = 0; f < draft.triangles.size(); ++f) {
    if (draft.origin[f] != origin) continue;
    const double share = barycentric(draft, draft.triangles[f], point).minCoeff();
    if (best < draft.triangles.size() && !(share > best_share)) continue;
    best = f;
    best_share = share;
  }
  return best;
}

void add_part(Draft& draft, std::size_t of, int a, int b, int c) {
  draft.triangles.emplace_back(a, b, c);
  draft.origin.push_back(draft.origin[of]);
}

void split_triangle(Draft& draft, std::size_t f, int vertex) {
  const Eigen::Vector3i t = draft.triangles[f];
  draft.triangles[f] = {t(0), t(1), vertex};
  add_part(draft, f, t(1), t(2), vertex);
  add_part(draft, f, t(2), t(0), vertex);
}

/// Splits the one or two triangles at the edge a - b.
void split_edge(Draft& draft, int a, int b, int vertex) {
  const std::size_t count = draft.triangles.size();
  for (std::size_t f = 0; f < count; ++f) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3i t = draft.triangles[f];
      const int from = t(k), to = t((k + 1) % 3), apex = t((k + 2) % 3);
      if (edge_of(from, to) != edge_of(a, b)) continue;
      draft.triangles[f] = {from, vertex, apex};
      add_part(draft, f, vertex, to, apex);
      break;
    }
  }
  if (draft.hard_edges.erase(edge_of(a, b)) == 0) return;
  draft.hard_edges.insert(edge_of(a, vertex));
  draft.hard_edges.insert(edge_of(b, vertex));
}

int insert_point(Draft& draft, int origin, const Eigen::Vector3d& point) {
  const std::size_t f = part_with(draft, origin, point);
  const Eigen::Vector3i triangle = draft.triangles[f];
  const Eigen::Vector3d weights = barycentric(draft, triangle, point);
  Eigen::Index nearest = 0, farthest = 0;
  if (weights.maxCoeff(&nearest) > 1 - kOnEdge) return triangle(nearest);
  const int vertex = static_cast<int>(draft.positions.size());
  draft.positions.push_back(point);
  if (weights.minCoeff(&farthest) < kOnEdge) {
    split_edge(draft, triangle((farthest + 1) % 3), triangle((farthest + 2) % 3), vertex);
  } else {
    split_triangle(draft, f, vertex);
  }
  return vertex;
}

}  // namespace

LandmarkedMesh insert_landmarks(const SourceSurface& surface) {
  Draft draft = draft_of(surface);
  LandmarkedMesh result;
  for (const SurfacePoint& landmark : surface.landmarks) {
    const Eigen::Vector3d point = position_of(surface.mesh, landmark);
    result.landmarks.push_back(insert_point(draft, landmark.triangle, point));
  }
  result.mesh.positions.resize(static_cast<Eigen::Index>(draft.positions.size()), 3);
  result.mesh.triangles.resize(static_cast<Eigen::Index>(draft.triangles.size()), 3);
  for (std::size_t v = 0; v < draft.positions.size(); ++v) {
    result.mesh.positions.row(static_cast<Eigen::Index>(v)) = draft.positions[v];
  }
  for (std::size_t f = 0; f < draft.triangles.size(); ++f) {
    result.mesh.triangles.row(static_cast<Eigen::Index>(f)) = draft.triangles[f];
  }
  for (const auto& [a, b] : draft.hard_edges) result.hard_edges.emplace_back(a, b);
  return result;
}

}  // namespace morphbake
