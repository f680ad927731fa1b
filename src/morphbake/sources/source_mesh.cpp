#include "morphbake/sources/source_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace morphbake {
namespace {

Positions to_scene(const Float3s& positions, const Eigen::Matrix4d& transform) {
  const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
  const Eigen::RowVector3d translation = transform.topRightCorner<3, 1>().transpose();
  return (positions.cast<double>() * linear.transpose()).rowwise() + translation;
}

}  // namespace

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
  SourceMesh mesh;
  mesh.name = source.name;
  mesh.file = open_gltf(source.file);
  mesh.geometry = read_source_geometry(mesh.file);
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
  mesh.welded = weld_rows(mesh.positions, mesh.welded_count);
  return mesh;
}

}  // namespace morphbake
