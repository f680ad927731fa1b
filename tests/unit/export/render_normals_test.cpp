#include "morphbake/export/render_normals.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "shapes/shapes.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using test::source_of;
using test::split_apart;

/// Flat normals by the file's own winding.
SourceMesh flat_source(const Mesh& mesh, const std::string& name) {
  const Mesh split = split_apart(mesh);
  SourceMesh source = source_of(split, name);
  PrimitiveGeometry primitive;
  primitive.triangles = source.triangles;
  primitive.positions = source.positions.cast<float>();
  primitive.normals.resize(split.positions.rows(), 3);
  for (Eigen::Index f = 0; f < split.triangles.rows(); ++f) {
    const Eigen::Vector3d a = split.positions.row(3 * f), b = split.positions.row(3 * f + 1),
                          c = split.positions.row(3 * f + 2);
    const Eigen::Vector3f normal = (b - a).cross(c - a).normalized().cast<float>();
    for (int k = 0; k < 3; ++k) primitive.normals.row(3 * f + k) = normal;
  }
  source.geometry.primitives = {primitive};
  return source;
}

/// Normal of each render vertex when the surface is turned as a whole.
Normals carried(const SourceMesh& source, const Eigen::Matrix3d& turn) {
  const MorphableMesh mesh = share_connectivity({source});
  const SmoothingGroups groups = find_smoothing_groups(source, mesh);
  const Normals of_group = deformed_normals(groups, mesh, mesh.geometries[0] * turn.transpose());
  return of_group(groups.of_render, Eigen::all);
}

void expect_all_turned(const SourceMesh& source) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Normals own = source.geometry.primitives[0].normals.cast<double>();
  EXPECT_LT((carried(source, Eigen::Matrix3d::Identity()) - own).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((carried(source, turn) - own * turn.transpose()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(RenderNormals, OfATurnedTriangleKeepTheFilesSideAndTurnWithTheSurface) {
  Mesh mesh = test::torus(7, 9);
  std::swap(mesh.triangles(31, 1), mesh.triangles(31, 2));
  const SourceMesh source = flat_source(mesh, "a");
  EXPECT_EQ(share_connectivity({source}).repairs.turned, 1);
  expect_all_turned(source);
}

TEST(RenderNormals, OfTheBackOfASheetThatIsMadeOfDuplicatesTurnToo) {
  const Mesh front = test::grid(4, 3);
  Mesh sheet = test::joined(front, front);
  sheet.triangles.bottomRows(front.triangles.rows())
      .col(1)
      .swap(sheet.triangles.bottomRows(front.triangles.rows()).col(2));
  const SourceMesh source = flat_source(sheet, "a");
  EXPECT_EQ(share_connectivity({source}).repairs.duplicate, front.triangles.rows());
  expect_all_turned(source);
}

TEST(RenderNormals, OfTwoSidesWithOneVertexListDoNotCancel) {
  Mesh sheet = test::grid(4, 3);
  const Triangles front = sheet.triangles;
  sheet.triangles.resize(2 * front.rows(), 3);
  sheet.triangles << front, front.rowwise().reverse();
  SourceMesh source = source_of(sheet, "a");
  PrimitiveGeometry primitive;
  primitive.normals = Float3s::Zero(sheet.positions.rows(), 3);
  primitive.normals.col(2).setOnes();
  source.geometry.primitives = {primitive};
  expect_all_turned(source);
}

}  // namespace
}  // namespace morphbake
