#include "morphbake/gltf/write_mesh.h"

#include <gtest/gtest.h>

namespace morphbake {
namespace {

PlainMesh triangle() {
  PlainMesh mesh;
  mesh.name = "leaf";
  mesh.triangles.resize(1, 3);
  mesh.triangles << 0, 1, 2;
  mesh.positions.resize(3, 3);
  mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  mesh.normals.resize(3, 3);
  mesh.normals << 0, 0, 1, 0, 0, 1, 0, 0, 1;
  return mesh;
}

AnimatedMesh read_back(const PlainMesh& mesh) {
  return read_animated_mesh(open_gltf_bytes(write_mesh_glb(mesh, "test"), "leaf.glb"));
}

TEST(WriteMesh, WithoutATextureHasNeitherPictureNorCoordinates) {
  PlainMesh mesh = triangle();
  mesh.material = PlainMaterial{};
  const AnimatedMesh read = read_back(mesh);
  EXPECT_EQ(read.primitives[0].texture_coordinates.rows(), 0);
  EXPECT_EQ(read.primitives[0].image, -1);
}

TEST(WriteMesh, GivesBackTextureAndCoordinates) {
  PlainMesh mesh = triangle();
  mesh.texture_coordinates.resize(3, 2);
  mesh.texture_coordinates << 0.25F, 0.5F, 0.75F, 0.5F, 0.25F, 0.125F;
  mesh.material = PlainMaterial{};
  mesh.material->base_colour_image = "as if a PNG";
  const AnimatedMesh read = read_back(mesh);
  EXPECT_EQ(read.primitives[0].texture_coordinates, mesh.texture_coordinates);
  ASSERT_EQ(read.primitives[0].image, 0);
  EXPECT_EQ(read.images[0], "as if a PNG");
  EXPECT_EQ(read.primitives[0].base_colour, Eigen::Vector3f::Ones());
}

}  // namespace
}  // namespace morphbake
