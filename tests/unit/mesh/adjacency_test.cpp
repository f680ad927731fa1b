#include "morphbake/mesh/adjacency.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"

namespace morphbake {
namespace {

Connectivity connectivity_of(const Mesh& mesh) {
  return {static_cast<int>(mesh.positions.rows()), mesh.triangles};
}

TEST(ManifoldDefects, FindsEachKind) {
  Connectivity crowded{5, Triangles(3, 3)};
  crowded.triangles << 0, 1, 2, 1, 0, 3, 0, 1, 4;
  EXPECT_EQ(find_manifold_defects(crowded, 3).crowded_edges.size(), 1U);

  Connectivity turned{4, Triangles(2, 3)};
  turned.triangles << 0, 1, 2, 0, 1, 3;
  EXPECT_EQ(find_manifold_defects(turned, 3).misoriented_triangles, std::vector<int>{1});

  Connectivity pinched{5, Triangles(2, 3)};
  pinched.triangles << 0, 1, 2, 0, 3, 4;
  EXPECT_EQ(find_manifold_defects(pinched, 3).pinched_vertices, std::vector<int>{0});

  Connectivity degenerate{4, Triangles(2, 3)};
  degenerate.triangles << 0, 1, 2, 1, 1, 2;
  const ManifoldDefects defects = find_manifold_defects(degenerate, 3);
  EXPECT_EQ(defects.degenerate_triangles, std::vector<int>{1});
  EXPECT_EQ(defects.unused_vertices, std::vector<int>{3});
}

TEST(ManifoldDefects, NoneOnManifolds) {
  for (const Mesh& mesh :
       {test::tetrahedron(), test::sphere(8, 12), test::torus(7, 9), test::grid(5, 4)}) {
    EXPECT_TRUE(find_manifold_defects(connectivity_of(mesh), 3).none());
  }
}

TEST(OneRings, EulerCharacteristicTellsTheGenus) {
  const auto characteristic = [](const Mesh& mesh) {
    const OneRings rings = one_rings(connectivity_of(mesh));
    return mesh.positions.rows() - static_cast<Eigen::Index>(rings.neighbours.size()) / 2 +
           mesh.triangles.rows();
  };
  EXPECT_EQ(characteristic(test::sphere(8, 12)), 2);
  EXPECT_EQ(characteristic(test::torus(7, 9)), 0);
  EXPECT_EQ(characteristic(test::grid(5, 4)), 1);
}

TEST(Components, CountsAndLabelsByFirstVertex) {
  const Mesh two = test::joined(test::sphere(6, 8), test::tetrahedron());
  const Components components = connected_components(one_rings(connectivity_of(two)));
  EXPECT_EQ(components.count, 2);
  EXPECT_EQ(components.label.front(), 0);
  EXPECT_EQ(components.label.back(), 1);
}

}  // namespace
}  // namespace morphbake
