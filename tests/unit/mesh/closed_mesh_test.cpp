#include "morphbake/mesh/closed_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "shapes/shapes.h"

namespace morphbake {
namespace {

std::set<std::array<int, 3>> triangle_set(const ClosedMesh& mesh) {
  std::set<std::array<int, 3>> all;
  const Triangles triangles = mesh.triangles();
  for (int f = 0; f < triangles.rows(); ++f) {
    std::array t{triangles(f, 0), triangles(f, 1), triangles(f, 2)};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    all.insert(t);
  }
  return all;
}

void expect_consistent(const ClosedMesh& mesh) {
  for (int f = 0; f < mesh.triangle_slots(); ++f) {
    if (!mesh.has_triangle(f)) continue;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      ASSERT_EQ(mesh.opposite(mesh.opposite(h)), h);
      ASSERT_EQ(mesh.from(mesh.opposite(h)), mesh.to(h));
      ASSERT_EQ(mesh.from(mesh.outgoing(mesh.from(h))), mesh.from(h));
    }
  }
}

TEST(ClosedMesh, TetrahedronCannotCollapse) {
  const Mesh shape = test::tetrahedron();
  const ClosedMesh mesh(shape.triangles, 4);
  EXPECT_FALSE(mesh.can_collapse(0));
  EXPECT_FALSE(mesh.can_flip(0));
}

TEST(ClosedMesh, UndoBringsEveryTriangleBack) {
  const Mesh shape = test::sphere(8, 12);
  ClosedMesh mesh(shape.triangles, static_cast<int>(shape.positions.rows()));
  const auto before = triangle_set(mesh);
  std::vector<CollapseRecord> records;
  for (bool any = true; any && mesh.vertex_count() > 4;) {
    any = false;
    for (int h = 0; h < 3 * mesh.triangle_slots() && mesh.vertex_count() > 4; ++h) {
      if (!mesh.has_triangle(h / 3) || !mesh.can_collapse(h)) continue;
      records.push_back(mesh.collapse(h));
      expect_consistent(mesh);
      any = true;
    }
  }
  EXPECT_EQ(mesh.vertex_count(), 4);
  for (; !records.empty(); records.pop_back()) mesh.undo(records.back());
  expect_consistent(mesh);
  EXPECT_EQ(triangle_set(mesh), before);
}

TEST(ClosedMesh, SplitsAndFlipsKeepTheSurfaceClosed) {
  const Mesh shape = test::sphere(4, 6);
  ClosedMesh mesh(shape.triangles, static_cast<int>(shape.positions.rows()));
  const int triangles = static_cast<int>(mesh.triangles().rows());
  const int v = mesh.split_triangle(3);
  EXPECT_EQ(mesh.valence(v), 3);
  expect_consistent(mesh);
  const int w = mesh.split_edge(5);
  EXPECT_EQ(mesh.valence(w), 4);
  expect_consistent(mesh);
  int flips = 0;
  for (int h = 0; h < 3 * mesh.triangle_slots(); ++h) {
    if (!mesh.can_flip(h)) continue;
    const int c = mesh.apex(h), d = mesh.apex(mesh.opposite(h));
    mesh.flip(h);
    EXPECT_EQ(mesh.from(h), d);
    EXPECT_EQ(mesh.to(h), c);
    ++flips;
  }
  EXPECT_GT(flips, 0);
  expect_consistent(mesh);
  EXPECT_EQ(mesh.triangles().rows(), triangles + 4);
}

}  // namespace
}  // namespace morphbake
