#include "morphbake/sources/source_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

Positions to_scene(const Float3s& positions, const Eigen::Matrix4d& transform) {
  const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
  const Eigen::RowVector3d translation = transform.topRightCorner<3, 1>().transpose();
  return (positions.cast<double>() * linear.transpose()).rowwise() + translation;
}

/// Squares and cubes of lengths must neither overflow nor vanish.
void check_size(const SourceMesh& mesh) {
  constexpr double kLargest = 1e60, kSmallest = 1e-60;
  const double reach = mesh.positions.size() == 0 ? 1 : mesh.positions.cwiseAbs().maxCoeff();
  if (reach < kLargest && (reach == 0 || reach > kSmallest)) return;
  throw BakeError(Problem{Severity::Error,
                          "gltf.extreme-size",
                          {file_of(mesh.file), fmt::format("/nodes/{}", mesh.geometry.node), 0, 0},
                          fmt::format("coordinates reach {:.3g} in the scene; {:.0e} to {:.0e} can "
                                      "be computed with",
                                      reach, kSmallest, kLargest),
                          "check the node's scale and matrix"});
}

/// Files hold floats, which lose their digits towards 1e-38: a morph of a tiny mesh would be
/// coarse.
void check_digits(const SourceMesh& mesh) {
  constexpr float kSmallest = 1e-30F;
  float reach = 0;
  for (const PrimitiveGeometry& primitive : mesh.geometry.primitives) {
    if (primitive.positions.size() == 0) continue;
    reach = std::max(reach, primitive.positions.cwiseAbs().maxCoeff());
  }
  if (reach == 0 || reach > kSmallest) return;
  throw BakeError(
      Problem{Severity::Error,
              "gltf.extreme-size",
              {file_of(mesh.file), fmt::format("/meshes/{}", mesh.geometry.mesh), 0, 0},
              fmt::format("coordinates reach {:.3g}; below {:.0e} the numbers of a file "
                          "lose their digits",
                          reach, kSmallest),
              "scale the mesh up, and the node down"});
}

}  // namespace

Float3s file_normals(const SourceMesh& source) {
  Float3s normals(source.positions.rows(), 3);
  Eigen::Index begin = 0;
  for (const PrimitiveGeometry& primitive : source.geometry.primitives) {
    if (primitive.normals.rows() == 0) return {};
    normals.middleRows(begin, primitive.normals.rows()) = primitive.normals;
    begin += primitive.normals.rows();
  }
  return begin == normals.rows() ? normals : Float3s();
}

std::vector<int> weld_rows(const Positions& positions, int& welded_count) {
  const auto count = static_cast<std::size_t>(positions.rows());
  const auto row = [&](int i) {
    // Adding 0 turns -0 into 0, which is the same point.
    return std::array{positions(i, 0) + 0.0, positions(i, 1) + 0.0, positions(i, 2) + 0.0};
  };
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto ra = row(a), rb = row(b);
    return ra == rb ? a < b : ra < rb;
  });
  std::vector<int> first(count);  // the first row that is equal
  for (std::size_t i = 0; i < count; ++i) {
    const bool same = i > 0 && row(order[i]) == row(order[i - 1]);
    first[static_cast<std::size_t>(order[i])] =
        same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  std::vector<int> welded(count);
  welded_count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto twin = static_cast<std::size_t>(first[i]);
    welded[i] = twin == i ? welded_count++ : welded[twin];
  }
  return welded;
}

SourceMesh load_source(const SourceRef& source) {
  return read_source(source.name, open_gltf(source.file), source.choice);
}

SourceMesh read_source(const std::string& name, const GltfFile& file, const MeshChoice& choice) {
  SourceMesh mesh;
  mesh.name = name;
  mesh.file = file;
  mesh.geometry = read_source_geometry(mesh.file, choice);
  Eigen::Index vertices = 0, triangles = 0;
  for (const PrimitiveGeometry& primitive : mesh.geometry.primitives) {
    vertices += primitive.positions.rows();
    triangles += primitive.triangles.rows();
  }
  mesh.positions.resize(vertices, 3);
  mesh.triangles.resize(triangles, 3);
  vertices = triangles = 0;
  for (const PrimitiveGeometry& primitive : mesh.geometry.primitives) {
    mesh.positions.middleRows(vertices, primitive.positions.rows()) =
        to_scene(primitive.positions, mesh.geometry.to_scene);
    mesh.triangles.middleRows(triangles, primitive.triangles.rows()) =
        primitive.triangles.array() + static_cast<int>(vertices);
    vertices += primitive.positions.rows();
    triangles += primitive.triangles.rows();
  }
  check_digits(mesh);
  check_size(mesh);
  mesh.welded = weld_rows(mesh.positions, mesh.welded_count);
  return mesh;
}

}  // namespace morphbake
