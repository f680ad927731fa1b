#include "morphbake/derive/free_form.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

std::string code_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const BakeError& error) {
    return error.problems().front().code;
  }
  return "";
}

/// Vertices of which `is_inside` says so of their position.
template <typename Rule>
std::vector<int> vertices_where(const Mesh& mesh, const Rule& is_inside) {
  std::vector<int> vertices;
  for (int v = 0; v < mesh.positions.rows(); ++v) {
    if (is_inside(Eigen::RowVector3d(mesh.positions.row(v)))) vertices.push_back(v);
  }
  return vertices;
}

std::vector<bool> mask_of(const Mesh& mesh, const std::vector<int>& vertices) {
  std::vector<bool> mask(static_cast<std::size_t>(mesh.positions.rows()), false);
  for (const int v : vertices) mask[static_cast<std::size_t>(v)] = true;
  return mask;
}

Handle moved(const Mesh& mesh, const std::vector<int>& vertices, const Eigen::Affine3d& by) {
  Handle handle{vertices, mesh.positions(vertices, Eigen::all)};
  for (auto row : handle.positions.rowwise()) row = (by * row.transpose()).transpose();
  return handle;
}

/// A bent sphere: fixed at the bottom, with handles at the top and at one side.
struct Face {
  Mesh mesh = test::sphere(22, 24);
  std::vector<bool> fixed;
  std::vector<Handle> handles;

  Face() {
    mesh.positions = test::bent(mesh.positions, 0.1, 3);
    fixed = mask_of(mesh, vertices_where(mesh, [](const auto& p) { return p.y() < -0.6; }));
    const auto top = vertices_where(mesh, [](const auto& p) { return p.y() > 0.8; });
    const auto side =
        vertices_where(mesh, [](const auto& p) { return p.x() > 0.75 && std::abs(p.y()) < 0.3; });
    const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1, 2, 3).normalized());
    handles = {moved(mesh, top, Eigen::Translation3d(0.2, 0.5, 0.1) * turn),
               moved(mesh, side, Eigen::Affine3d(Eigen::Translation3d(0.4, 0, -0.3)))};
  }
};

/// Eq. 8 by a dense least-squares fit: L of every vertex, over the columns of the free ones.
Positions dense_free_form(const Mesh& mesh, const std::vector<bool>& fixed,
                          const std::vector<Handle>& handles) {
  const auto vertex_count = static_cast<int>(mesh.positions.rows());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(vertex_count, vertex_count);
  for (const auto& triangle : mesh.triangles.rowwise()) {
    for (int k = 0; k < 3; ++k) {
      A(triangle(k), triangle((k + 1) % 3)) = A(triangle((k + 1) % 3), triangle(k)) = 1;
    }
  }
  const Eigen::MatrixXd L = Eigen::MatrixXd::Identity(vertex_count, vertex_count) -
                            A.rowwise().sum().cwiseInverse().asDiagonal() * A;
  std::vector<bool> is_free(fixed.size());
  for (std::size_t v = 0; v < fixed.size(); ++v) is_free[v] = !fixed[v];
  Positions result = mesh.positions;
  for (const Handle& handle : handles) {
    for (std::size_t k = 0; k < handle.vertices.size(); ++k) {
      is_free[static_cast<std::size_t>(handle.vertices[k])] = false;
      result.row(handle.vertices[k]) = handle.positions.row(static_cast<Eigen::Index>(k));
    }
  }
  std::vector<int> free;
  for (int v = 0; v < vertex_count; ++v) {
    if (!is_free[static_cast<std::size_t>(v)]) continue;
    free.push_back(v);
    result.row(v).setZero();
  }
  const Eigen::MatrixXd W = L * mesh.positions;
  result(free, Eigen::all) = L(Eigen::all, free).colPivHouseholderQr().solve(W - L * result);
  return result;
}

TEST(FreeForm, RefusesAVertexThatTwoHold) {
  const Face face;
  const auto code = [&](const std::vector<bool>& fixed, const std::vector<Handle>& handles) {
    return code_of([&] { free_form(face.mesh, fixed, handles); });
  };
  const std::vector<Handle> twice = {face.handles[0], face.handles[0]};
  EXPECT_EQ(code(face.fixed, twice), "derive.overlapping-handles");
  EXPECT_EQ(code(mask_of(face.mesh, {face.handles[1].vertices[0]}), face.handles),
            "derive.overlapping-handles");
  const Handle doubled{{0, 0}, Positions::Zero(2, 3)};
  EXPECT_EQ(code(face.fixed, {doubled}), "derive.overlapping-handles");
}

TEST(FreeForm, RefusesPositionsThatAreNoNumbers) {
  Face face;
  face.handles[0].positions(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of([&] { free_form(face.mesh, face.fixed, face.handles); }), "solve.not-finite");
}

TEST(FreeForm, EqualsADenseLeastSquaresFit) {
  const Face face;
  ASSERT_GT(face.mesh.positions.rows(), 500);
  const Positions expected = dense_free_form(face.mesh, face.fixed, face.handles);
  const Positions result = free_form(face.mesh, face.fixed, face.handles);
  EXPECT_LT(largest_distance(result, expected), 1e-9 * bounding_diagonal(face.mesh.positions));
  EXPECT_GT(largest_distance(result, face.mesh.positions), 0.3);
}

TEST(FreeForm, MeetsHandlesAndFixedVerticesExactly) {
  const Face face;
  const Positions result = free_form(face.mesh, face.fixed, face.handles);
  for (const Handle& handle : face.handles) {
    EXPECT_EQ(result(handle.vertices, Eigen::all), handle.positions);
  }
  for (int v = 0; v < result.rows(); ++v) {
    if (face.fixed[static_cast<std::size_t>(v)]) {
      EXPECT_EQ(result.row(v), face.mesh.positions.row(v)) << v;
    }
  }
}

TEST(FreeForm, LeavesTheSourceAloneWhenHandlesAre) {
  Face face;
  for (Handle& handle : face.handles) {
    handle.positions = face.mesh.positions(handle.vertices, Eigen::all);
  }
  EXPECT_EQ(free_form(face.mesh, face.fixed, face.handles), face.mesh.positions);
  EXPECT_EQ(free_form(face.mesh, face.fixed, {}), face.mesh.positions);
}

TEST(FreeForm, EqualsADenseFitWhereNothingIsFixed) {
  const Face face;
  const std::vector<bool> nothing(face.fixed.size(), false);
  const std::vector<Handle> one = {face.handles[0]};
  const Positions expected = dense_free_form(face.mesh, nothing, one);
  EXPECT_LT(largest_distance(free_form(face.mesh, nothing, one), expected),
            1e-9 * bounding_diagonal(face.mesh.positions));
}

TEST(FreeForm, TranslatesAComponentThatNothingElseHolds) {
  Face face;
  face.handles = {face.handles[1]};
  const Eigen::RowVector3d shift(0.5, -0.25, 2);
  face.handles[0].positions =
      face.mesh.positions(face.handles[0].vertices, Eigen::all).rowwise() + shift;
  const Positions result =
      free_form(face.mesh, std::vector<bool>(face.fixed.size(), false), face.handles);
  EXPECT_LT(largest_distance(result, face.mesh.positions.rowwise() + shift), 1e-10);
}

TEST(FreeForm, LeavesOtherComponentsAlone) {
  const Face face;
  // Isolated needles and a vertex without triangles, far away.
  Mesh needles{Positions(4, 3), Triangles(1, 3)};
  needles.positions << 1e3, 0, 0, 1e3, 1e-9, 0, 2e3, 0, 0, 5, 5, 5;
  needles.triangles << 0, 1, 2;
  const Mesh both = test::joined(face.mesh, needles);
  std::vector<bool> fixed = face.fixed;
  fixed.resize(fixed.size() + 4, false);
  const Positions result = free_form(both, fixed, face.handles);
  EXPECT_EQ(result.bottomRows(4), needles.positions);
  const Positions expected = free_form(face.mesh, face.fixed, face.handles);
  EXPECT_LT(largest_distance(result.topRows(expected.rows()), expected), 1e-9);
}

TEST(FreeForm, GivesNumbersOnDegenerateMeshes) {
  Mesh flat = test::sphere(10, 12);
  flat.positions.col(0).setZero();
  flat.positions.col(1).setZero();
  const auto fixed = mask_of(flat, {0, 1});
  const Handle handle{{60}, Eigen::RowVector3d(1, 1, 1)};
  EXPECT_TRUE(free_form(flat, fixed, {handle}).allFinite());
  Mesh strip = test::grid(200, 2);
  strip.positions.col(1) *= 1e-12;
  EXPECT_TRUE(free_form(strip, mask_of(strip, {0, 200}), {{{199}, {Eigen::RowVector3d(9, 9, 9)}}})
                  .allFinite());
}

TEST(FreeForm, TakesAMeshThatIsAllHandle) {
  const Mesh mesh = test::tetrahedron();
  Handle handle{{0, 1, 2}, mesh.positions.topRows(3) * 2};
  const Positions result = free_form(mesh, {false, false, false, true}, {handle});
  EXPECT_EQ(result.topRows(3), handle.positions);
  EXPECT_EQ(result.row(3), mesh.positions.row(3));
}

}  // namespace
}  // namespace morphbake
