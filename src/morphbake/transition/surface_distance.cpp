#include "morphbake/transition/surface_distance.h"

#include <CGAL/Eigen_matrix.h>
#include <CGAL/Eigen_vector.h>
#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/Geometry>
#include <array>
#include <cassert>
#include <limits>
#include <optional>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using VertexIndex = Surface::Vertex_index;

/// A centre this close to an edge or a vertex, in barycentric coordinates, lies on it: splitting
/// off a thinner triangle would only add a needle.
constexpr double kOnEdge = 1e-3;

Surface to_cgal(const Mesh& mesh) {
  Surface surface;
  surface.reserve(static_cast<Surface::size_type>(mesh.positions.rows()),
                  static_cast<Surface::size_type>(3 * mesh.triangles.rows() / 2),
                  static_cast<Surface::size_type>(mesh.triangles.rows()));
  for (int v = 0; v < mesh.positions.rows(); ++v) {
    surface.add_vertex(Point(mesh.positions(v, 0), mesh.positions(v, 1), mesh.positions(v, 2)));
  }
  // Not add_face, which looks around each vertex every time: for ever at the hub of a large fan.
  std::vector<std::array<VertexIndex, 3>> faces;
  for (const auto& corners : mesh.triangles.rowwise()) {
    auto& face = faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      face[k] = VertexIndex(static_cast<unsigned>(corners(static_cast<Eigen::Index>(k))));
    }
  }
  CGAL::Euler::add_faces(faces, surface);
  return surface;
}

Point weighted(const Surface& surface, const std::array<VertexIndex, 3>& corners,
               const Eigen::Vector3d& weights) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Point& p = surface.point(corners[static_cast<std::size_t>(k)]);
    sum += weights(k) * Eigen::Vector3d(p.x(), p.y(), p.z());
  }
  return {sum.x(), sum.y(), sum.z()};
}

VertexIndex split_edge(Surface& surface, Surface::Halfedge_index edge, const Point& point) {
  const auto first = CGAL::Euler::split_edge(edge, surface);  // points at the new vertex
  const VertexIndex vertex = surface.target(first);
  surface.point(vertex) = point;
  for (const auto side : {first, surface.opposite(surface.next(first))}) {
    if (!surface.is_border(side)) {
      CGAL::Euler::split_face(side, surface.next(surface.next(side)), surface);
    }
  }
  return vertex;
}

/// Makes a point of the original mesh a vertex of `surface`; none where an earlier point has split
/// its triangle.
std::optional<VertexIndex> insert_point(Surface& surface, const Mesh& mesh,
                                        const SurfacePoint& at) {
  std::array<VertexIndex, 3> corners;
  for (int k = 0; k < 3; ++k) {
    corners[static_cast<std::size_t>(k)] =
        VertexIndex(static_cast<unsigned>(mesh.triangles(at.triangle, k)));
  }
  int near = 0;  // how many corners have no share to speak of
  int last_near = 0, last_far = 0;
  for (int k = 0; k < 3; ++k) {
    const bool is_near = at.barycentric(k) < kOnEdge;
    near += is_near;
    (is_near ? last_near : last_far) = k;
  }
  if (near == 2) return corners[static_cast<std::size_t>(last_far)];
  const Point point = weighted(surface, corners, at.barycentric);
  if (near == 1) {
    const VertexIndex a = corners[static_cast<std::size_t>((last_near + 1) % 3)];
    const VertexIndex b = corners[static_cast<std::size_t>((last_near + 2) % 3)];
    const auto edge = surface.halfedge(a, b);
    if (!edge.is_valid()) return std::nullopt;
    return split_edge(surface, edge, point);
  }
  const auto inside = surface.halfedge(corners[0], corners[1]);
  if (!inside.is_valid() || surface.target(surface.next(inside)) != corners[2]) return std::nullopt;
  const auto spoke = CGAL::Euler::add_center_vertex(inside, surface);
  surface.point(surface.target(spoke)) = point;
  return surface.target(spoke);
}

/// The part of a mesh that is connected with one triangle: the heat method divides by zero
/// elsewhere.
struct Part {
  Mesh mesh;
  std::vector<int> vertex_of_part;  ///< vertex of the part -> vertex of the whole
};

Part part_of_component(const Mesh& mesh, const Components& components, int label) {
  Part part;
  std::vector<int> number(components.label.size(), -1);
  for (std::size_t v = 0; v < components.label.size(); ++v) {
    if (components.label[v] != label) continue;
    number[v] = static_cast<int>(part.vertex_of_part.size());
    part.vertex_of_part.push_back(static_cast<int>(v));
  }
  part.mesh.positions = mesh.positions(part.vertex_of_part, Eigen::all);
  std::vector<int> kept;
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    if (number[static_cast<std::size_t>(mesh.triangles(f, 0))] >= 0) kept.push_back(f);
  }
  part.mesh.triangles = mesh.triangles(kept, Eigen::all);
  for (int& vertex : part.mesh.triangles.reshaped())
    vertex = number[static_cast<std::size_t>(vertex)];
  return part;
}

/// Whether a triangle is so thin that CGAL's intrinsic flips might go round in circles.
bool has_needles(const Mesh& mesh) {
  constexpr double kThinnest = 1e-10;  // height over longest side
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return mesh.positions.row(mesh.triangles(f, k % 3));
    };
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (corner(k + 1) - corner(k)).squaredNorm());
    }
    const double area = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    if (!(area > kThinnest * longest)) return true;
  }
  return false;
}

/// CGAL's SparseLinearAlgebraWithFactorTraits_d by our factor: Eigen's, its default, takes several
/// times as long on large meshes.
class HeatSolver {
 public:
  using NT = double;
  using Index = int;
  using Matrix = CGAL::Eigen_sparse_matrix<double>;
  using Vector = CGAL::Eigen_vector<double>;

  bool factor(const Matrix& of, NT& scale) {
    scale = 1;
    SymmetricSystem system{of.eigen_object(), {}, 0};
    const auto rows = static_cast<std::size_t>(system.matrix.rows());
    const bool is_singular = sums_to_zero(system.matrix);
    system.singular_block.assign(rows, is_singular ? 0 : -1);
    system.singular_block_count = is_singular ? 1 : 0;
    factor_.emplace(system);
    return true;
  }

  bool linear_solver(const Matrix& b, Vector& x) {
    x = factor_->solve(Eigen::MatrixXd(b.eigen_object())).col(0);
    return true;
  }

 private:
  /// Of the heat method's two matrices the Laplacian alone has rows that sum to 0, but for
  /// rounding; in the other one the vertices' areas are left.
  static bool sums_to_zero(const Eigen::SparseMatrix<double>& matrix) {
    constexpr double kRounding = 1e-13;
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(matrix.cols());
    const Eigen::VectorXd sums = (matrix * ones).cwiseAbs(), sizes = matrix.cwiseAbs() * ones;
    return (sums.array() <= kRounding * sizes.array()).all();
  }

  std::optional<CholeskyFactor> factor_;
};

using HeatMethod = CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<
    Surface, CGAL::Heat_method_3::Intrinsic_Delaunay, CGAL::Default, HeatSolver>;

/// Distances from the sources of `heat` to the first `count` vertices.
Eigen::VectorXd distances_of(HeatMethod& heat, Surface& surface,
                             const std::vector<VertexIndex>& sources, Eigen::Index count) {
  auto distance = surface.add_property_map<VertexIndex, double>("v:distance", 0).first;
  heat.estimate_geodesic_distances(distance);
  Eigen::VectorXd result(count);
  for (int v = 0; v < count; ++v) result(v) = distance[VertexIndex(static_cast<unsigned>(v))];
  // The heat method fixes its constant at the least value, which need not be at a source.
  double zero = 0;
  for (const VertexIndex source : sources) zero += distance[source];
  return (result.array() - zero / static_cast<double>(sources.size())).max(0);
}

/// Distances on a connected mesh from those sets whose points can all be inserted into one surface;
/// the others' stay without rows.
///
/// @param open  indices of the sets to do; those done are taken out
void heat_distances(const Mesh& mesh, const std::vector<PointSet>& sets,
                    std::vector<std::size_t>& open, std::vector<Eigen::VectorXd>& distances) {
  Surface surface = to_cgal(mesh);
  std::vector<std::pair<std::size_t, std::vector<VertexIndex>>> inserted;
  std::vector<std::size_t> left;
  for (const std::size_t set : open) {
    std::vector<VertexIndex> vertices;
    for (const SurfacePoint& at : sets[set]) {
      if (const auto vertex = insert_point(surface, mesh, at)) vertices.push_back(*vertex);
    }
    // Of a set alone in its surface, points in one triangle that cannot all be inserted are so
    // close to one another that those which could be stand for them.
    const bool is_whole = vertices.size() == sets[set].size() || set == open.front();
    if (is_whole) {
      inserted.emplace_back(set, std::move(vertices));
    } else {
      left.push_back(set);
    }
  }
  HeatMethod heat(surface);
  for (const auto& [set, vertices] : inserted) {
    heat.clear_sources();
    for (const VertexIndex vertex : vertices) heat.add_source(vertex);
    distances[set] = distances_of(heat, surface, vertices, mesh.positions.rows());
  }
  open = std::move(left);
}

/// The sets' points on one component, as points of its part.
std::vector<PointSet> on_component(const Mesh& mesh, const Components& components, int label,
                                   const std::vector<PointSet>& sets) {
  // Triangles keep their order in the part: their numbers there are found by counting.
  std::vector<int> number(static_cast<std::size_t>(mesh.triangles.rows()), -1);
  int next = 0;
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    const auto corner = static_cast<std::size_t>(mesh.triangles(f, 0));
    if (components.label[corner] == label) number[static_cast<std::size_t>(f)] = next++;
  }
  std::vector<PointSet> there(sets.size());
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (const SurfacePoint& at : sets[i]) {
      const int triangle = number[static_cast<std::size_t>(at.triangle)];
      if (triangle >= 0) there[i].push_back({triangle, at.barycentric});
    }
  }
  return there;
}

[[noreturn]] void fail_without_area() {
  throw BakeError(
      Problem{Severity::Error,
              "transition.distance-failed",
              {},
              "the geodesic distance is not finite: the surface has triangles without area",
              "set \"distance\": \"edges\" for the region"});
}

}  // namespace

std::vector<Eigen::VectorXd> geodesic_distances(const Mesh& mesh,
                                                const std::vector<PointSet>& sets) {
  const Components components =
      connected_components(one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles}));
  std::vector<Eigen::VectorXd> distances(
      sets.size(),
      Eigen::VectorXd::Constant(mesh.positions.rows(), std::numeric_limits<double>::infinity()));
  for (int label = 0; label < components.count; ++label) {
    const std::vector<PointSet> there = on_component(mesh, components, label, sets);
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < there.size(); ++i) {
      if (!there[i].empty()) open.push_back(i);
    }
    if (open.empty()) continue;
    const std::vector<std::size_t> asked = open;
    const Part part = part_of_component(mesh, components, label);
    if (has_needles(part.mesh)) fail_without_area();
    std::vector<Eigen::VectorXd> inside(sets.size());
    while (!open.empty()) heat_distances(part.mesh, there, open, inside);
    for (const std::size_t i : asked) {
      if (!inside[i].allFinite()) fail_without_area();
      distances[i](part.vertex_of_part) = inside[i];
    }
  }
  return distances;
}

struct VertexDistances::Heat {
  explicit Heat(const Mesh& mesh) : surface(to_cgal(mesh)), method(surface) {}

  Surface surface;
  HeatMethod method;
};

VertexDistances::VertexDistances(const Mesh& mesh) : mesh_(mesh) {
  if (!has_needles(mesh)) heat_ = std::make_unique<Heat>(mesh);
}

VertexDistances::~VertexDistances() = default;

Eigen::VectorXd VertexDistances::from(int vertex) {
  if (heat_) {
    const VertexIndex source(static_cast<unsigned>(vertex));
    heat_->method.clear_sources();
    heat_->method.add_source(source);
    Eigen::VectorXd distances =
        distances_of(heat_->method, heat_->surface, {source}, mesh_.positions.rows());
    if (distances.allFinite()) return distances;
  }
  for (int f = 0; f < mesh_.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (mesh_.triangles(f, k) == vertex)
        return edge_distances(mesh_, {{f, Eigen::Vector3d::Unit(k)}});
    }
  }
  assert(false);  // every vertex of a connected mesh has a triangle
  return {};
}

}  // namespace morphbake
