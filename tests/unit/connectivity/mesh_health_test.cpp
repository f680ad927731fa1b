#include "morphbake/connectivity/mesh_health.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using test::source_of;
using test::split_apart;

MeshHealth health_of(const Mesh& mesh) { return examine_mesh(source_of(mesh, "a")); }

Mesh with_triangles(Mesh mesh, const std::vector<Eigen::RowVector3i>& triangles) {
  for (const Eigen::RowVector3i& triangle : triangles) {
    mesh.triangles.conservativeResize(mesh.triangles.rows() + 1, 3);
    mesh.triangles.bottomRows(1) = triangle;
  }
  return mesh;
}

TEST(MeshHealth, TellsCrowdedEdgesAndPinchedVertices) {
  const Mesh finned = with_triangles(test::grid(3, 3), {{4, 0, 8}});
  const MeshHealth crowded = health_of(finned);
  EXPECT_TRUE(crowded.is_refused());
  EXPECT_EQ(crowded.crowded_edges.count, 2);
  EXPECT_EQ(crowded.crowded_edges.places.size(), 2U);
  EXPECT_FALSE(crowded.genus);
  EXPECT_FALSE(crowded.self_intersections);
  Mesh second = test::grid(3, 3);
  second.positions.rowwise() += Eigen::RowVector3d(2, 2, 0);
  const MeshHealth pinched = health_of(split_apart(test::joined(test::grid(3, 3), second)));
  EXPECT_TRUE(pinched.is_refused());
  EXPECT_EQ(pinched.pinched_vertices.count, 1);
  EXPECT_EQ(pinched.pinched_vertices.places[0].position, Eigen::RowVector3d(2, 2, 0));
  EXPECT_EQ(pinched.components, 1);
}

TEST(MeshHealth, TellsOfPiecesWithOneSide) {
  Mesh strip{Positions(6, 3), Triangles(6, 3)};
  strip.positions << 1, 0, 0, 1, 0, 1, -1, 1, 0, -1, 1, 1, -1, -1, 0, -1, -1, 1;
  strip.triangles << 0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4, 4, 5, 1, 5, 0, 1;
  const MeshHealth health = health_of(strip);
  EXPECT_TRUE(health.is_refused());
  EXPECT_EQ(health.twisted_pieces.count, 1);
  EXPECT_EQ(health.turned_triangles.count, 0);
}

TEST(MeshHealth, OfNoSurfaceAtAll) {
  const MeshHealth nothing = health_of({Positions(3, 3), Triangles(0, 3)});
  EXPECT_TRUE(nothing.is_refused());
  EXPECT_EQ(nothing.unused_vertices, 3);
  EXPECT_EQ(nothing.components, 0);
  const MeshHealth flat = health_of({Positions::Zero(3, 3), Eigen::RowVector3i(0, 1, 2)});
  EXPECT_TRUE(flat.is_refused());
  EXPECT_EQ(flat.degenerate_triangles.count, 1);
}

TEST(MeshHealth, TellsTheShape) {
  struct Expected {
    Mesh mesh;
    int components, loops, genus;
  };

  for (const auto& [mesh, components, loops, genus] :
       {Expected{test::sphere(8, 10), 1, 0, 0}, Expected{test::torus(7, 9), 1, 0, 1},
        Expected{test::grid(4, 4), 1, 1, 0},
        Expected{test::joined(test::torus(7, 9), test::grid(4, 4)), 2, 1, 1}}) {
    const MeshHealth health = health_of(split_apart(mesh));
    EXPECT_FALSE(health.is_refused());
    EXPECT_EQ(health.components, components);
    EXPECT_EQ(health.boundary_loops, loops);
    EXPECT_EQ(health.genus, genus);
    EXPECT_EQ(health.welded_vertices, mesh.positions.rows());
    EXPECT_EQ(health.render_vertices, mesh.triangles.size());
    EXPECT_EQ(health.open_seams.count, 0);
  }
}

TEST(MeshHealth, CountsWhatABakeMends) {
  const Mesh torus = test::torus(7, 9);
  const Triangles& t = torus.triangles;
  Mesh mesh = with_triangles(torus, {{3, 3, 4}, t.row(5), t.row(9).reverse()});
  std::swap(mesh.triangles(40, 0), mesh.triangles(40, 1));
  mesh.positions.conservativeResize(mesh.positions.rows() + 2, 3);
  mesh.positions.bottomRows(2).setConstant(7);
  const MeshHealth health = health_of(mesh);
  EXPECT_FALSE(health.is_refused());
  EXPECT_EQ(health.degenerate_triangles.count, 1);
  EXPECT_EQ(health.degenerate_triangles.places[0].triangle, t.rows());
  EXPECT_EQ(health.duplicate_triangles.count, 2);
  EXPECT_EQ(health.duplicate_triangles.places[1].triangle, t.rows() + 2);
  EXPECT_EQ(health.turned_triangles.count, 1);
  EXPECT_EQ(health.turned_triangles.places[0].triangle, 40);
  EXPECT_EQ(health.unused_vertices, 2);
  EXPECT_EQ(health.genus, 1);
}

TEST(MeshHealth, AMirroredNodeTurnsNothing) {
  SourceMesh source = source_of(test::torus(7, 9), "a");
  source.geometry.to_scene(0, 0) = -1;
  EXPECT_EQ(examine_mesh(source).turned_triangles.count, 0);
  std::swap(source.triangles(40, 0), source.triangles(40, 1));
  const MeshHealth health = examine_mesh(source);
  EXPECT_EQ(health.turned_triangles.count, 1);
  EXPECT_EQ(health.turned_triangles.places[0].triangle, 40);
}

TEST(MeshHealth, FindsSelfIntersectionsAndOpenSeams) {
  Mesh moved = test::sphere(8, 10);
  moved.positions.rowwise() += Eigen::RowVector3d(1, 0.1, 0.2);
  const MeshHealth cut = health_of(test::joined(test::sphere(8, 10), moved));
  ASSERT_TRUE(cut.self_intersections);
  EXPECT_GT(cut.self_intersections->count, 10);
  EXPECT_EQ(cut.self_intersections->places.size(), 3U);
  EXPECT_FALSE(cut.is_refused());
  EXPECT_EQ(health_of(test::sphere(8, 10)).self_intersections->count, 0);

  Mesh beside = test::grid(3, 3);
  beside.positions.col(0).array() += 2 + 1e-7;
  EXPECT_EQ(health_of(test::joined(test::grid(3, 3), beside)).open_seams.count, 4);
}

TEST(MeshHealth, StopsWhenItIsAskedTo) {
  Observer observer;
  observer.is_cancelled = [] { return true; };
  EXPECT_THROW(examine_mesh(source_of(test::tetrahedron(), "a"), observer), Cancelled);
}

}  // namespace
}  // namespace morphbake
