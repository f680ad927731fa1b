#include "morphbake/transition/surface_distance.h"

#include <CGAL/Eigen_matrix.h>
#include <CGAL/Eigen_vector.h>
#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/surface_point.h"

namespace morphbake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using VertexIndex = Surface::Vertex_index;

/// A centre this close to an edge or a vertex, in barycentric coordinates, lies on it: splitting
/// off a thinner triangle would only add a needle.
constexpr double kOnEdge = 1e-3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

/// A mesh of which points become vertices: the triangle or edge that each lies on is split.
class SplitSurface {
 public:
  explicit SplitSurface(const Mesh& mesh) : mesh_(mesh), surface_(to_cgal(mesh)) {}

  Surface& surface() { return surface_; }

  /// The vertex at a point of the original mesh.
  VertexIndex insert(const SurfacePoint& at) {
    const Eigen::Vector3d position = position_of(mesh_, at);
    const Corners corners = corners_of(face_at(at.triangle, position));
    const Eigen::Vector3d shares = plane_coordinates(positions_of(corners), position);
    std::vector<std::size_t> near, far;
    for (std::size_t k = 0; k < 3; ++k) {
      (shares(static_cast<Eigen::Index>(k)) < kOnEdge ? near : far).push_back(k);
    }
    if (far.size() == 1) return surface_.target(corners[far[0]]);
    const Point point(position.x(), position.y(), position.z());
    return near.empty() ? split_face(corners[0], point)
                        : split_edge(corners[(near[0] + 2) % 3], point);
  }

 private:
  using Face = Surface::Face_index;
  using Halfedge = Surface::Halfedge_index;
  using Corners = std::array<Halfedge, 3>;  ///< each points at its corner

  Corners corners_of(Face face) const {
    const Halfedge first = surface_.halfedge(face);
    return {first, surface_.next(first), surface_.next(surface_.next(first))};
  }

  Eigen::Matrix3d positions_of(const Corners& corners) const {
    Eigen::Matrix3d positions;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& p = surface_.point(surface_.target(corners[k]));
      positions.row(static_cast<Eigen::Index>(k)) << p.x(), p.y(), p.z();
    }
    return positions;
  }

  /// The part of a triangle in which a point lies.
  Face face_at(int triangle, const Eigen::Vector3d& position) const {
    Face best(static_cast<unsigned>(triangle));
    double most = -kInfinity;
    const auto consider = [&](Face face) {
      const double least = plane_coordinates(positions_of(corners_of(face)), position).minCoeff();
      if (least > most) best = face;
      most = std::max(most, least);
    };
    consider(best);
    for (std::size_t i = 0; i < triangle_of_part_.size(); ++i) {
      if (triangle_of_part_[i] == triangle) consider(part(i));
    }
    return best;
  }

  Face part(std::size_t i) const {
    return Face(static_cast<unsigned>(static_cast<std::size_t>(mesh_.triangles.rows()) + i));
  }

  /// The triangle of the mesh that a face is a part of.
  int triangle_of(Face face) const {
    const auto original = static_cast<std::size_t>(mesh_.triangles.rows());
    return face.idx() < original ? static_cast<int>(face.idx())
                                 : triangle_of_part_[face.idx() - original];
  }

  VertexIndex split_face(Halfedge side, const Point& point) {
    const int triangle = triangle_of(surface_.face(side));
    const VertexIndex vertex = surface_.target(CGAL::Euler::add_center_vertex(side, surface_));
    surface_.point(vertex) = point;
    triangle_of_part_.insert(triangle_of_part_.end(), 2, triangle);
    return vertex;
  }

  VertexIndex split_edge(Halfedge edge, const Point& point) {
    const Halfedge first = CGAL::Euler::split_edge(edge, surface_);  // points at the new vertex
    const VertexIndex vertex = surface_.target(first);
    surface_.point(vertex) = point;
    for (const Halfedge side : {first, surface_.opposite(surface_.next(first))}) {
      if (surface_.is_border(side)) continue;
      triangle_of_part_.push_back(triangle_of(surface_.face(side)));
      CGAL::Euler::split_face(side, surface_.next(surface_.next(side)), surface_);
    }
    return vertex;
  }

  const Mesh& mesh_;
  Surface surface_;                    ///< the mesh's faces come first, each a part of itself
  std::vector<int> triangle_of_part_;  ///< of the other faces
};

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
    constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();  // of one entry
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(matrix.cols());
    const Eigen::VectorXd sums = (matrix * ones).cwiseAbs(), sizes = matrix.cwiseAbs() * ones;
    for (Eigen::Index row = 0; row < matrix.outerSize(); ++row) {
      const double entries = matrix.outerIndexPtr()[row + 1] - matrix.outerIndexPtr()[row];
      if (sums(row) > kRounding * entries * sizes(row)) return false;
    }
    return true;
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

[[noreturn]] void fail_without_area(const Location& where) {
  throw BakeError(
      Problem{Severity::Error, "transition.distance-failed", where,
              "the geodesic distance is not finite: the surface has triangles without area",
              "set \"distance\": \"edges\" for the region"});
}

}  // namespace

/// One component, whose points of all sets are vertices.
struct GeodesicDistances::Component {
  Component(Part of, const std::vector<PointSet>& sets) : part(std::move(of)), split(part.mesh) {
    for (const PointSet& set : sets) {
      auto& vertices = vertices_of_set.emplace_back();
      for (const SurfacePoint& at : set) vertices.push_back(split.insert(at));
    }
    heat.emplace(split.surface());
  }

  VertexIndex vertex_at(int vertex_of_whole) const {
    const auto& all = part.vertex_of_part;  // rising
    const auto found = std::lower_bound(all.begin(), all.end(), vertex_of_whole);
    return VertexIndex(static_cast<unsigned>(found - all.begin()));
  }

  /// Puts the distances from some vertices of this component into those of the whole mesh.
  /// @return whether they are finite
  bool measure(const std::vector<VertexIndex>& from, Eigen::VectorXd& distances) {
    heat->clear_sources();
    for (const VertexIndex vertex : from) heat->add_source(vertex);
    const Eigen::VectorXd inside =
        distances_of(*heat, split.surface(), from, part.mesh.positions.rows());
    distances(part.vertex_of_part) = inside;
    return inside.allFinite();
  }

  Part part;
  SplitSurface split;
  std::vector<std::vector<VertexIndex>> vertices_of_set;
  std::optional<HeatMethod> heat;
};

GeodesicDistances::GeodesicDistances(const Mesh& mesh, std::vector<PointSet> sets, Location where)
    : mesh_(&mesh),
      sets_(std::move(sets)),
      where_(std::move(where)),
      components_(connected_components(
          one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles}))),
      asked_(static_cast<std::size_t>(components_.count)) {}

GeodesicDistances::~GeodesicDistances() = default;
GeodesicDistances::GeodesicDistances(GeodesicDistances&&) noexcept = default;

GeodesicDistances::Component& GeodesicDistances::component(int label) {
  std::unique_ptr<Component>& asked = asked_[static_cast<std::size_t>(label)];
  if (!asked) {
    Part part = part_of_component(*mesh_, components_, label);
    if (has_needles(part.mesh)) fail_without_area(where_);
    asked = std::make_unique<Component>(std::move(part),
                                        on_component(*mesh_, components_, label, sets_));
  }
  return *asked;
}

int GeodesicDistances::label_of(const SurfacePoint& at) const {
  return components_.label[static_cast<std::size_t>(mesh_->triangles(at.triangle, 0))];
}

Eigen::VectorXd GeodesicDistances::from_set(std::size_t i) {
  std::set<int> labels;
  for (const SurfacePoint& at : sets_[i]) labels.insert(label_of(at));
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(mesh_->positions.rows(), kInfinity);
  for (const int label : labels) {
    Component& there = component(label);
    if (!there.measure(there.vertices_of_set[i], distances)) fail_without_area(where_);
  }
  return distances;
}

Eigen::VectorXd GeodesicDistances::from_vertices(const std::vector<int>& vertices) {
  std::map<int, std::vector<VertexIndex>> by_label;
  for (const int vertex : vertices) {
    const int label = components_.label[static_cast<std::size_t>(vertex)];
    by_label[label].push_back(component(label).vertex_at(vertex));
  }
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(mesh_->positions.rows(), kInfinity);
  for (const auto& [label, from] : by_label) {
    if (!component(label).measure(from, distances)) fail_without_area(where_);
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
