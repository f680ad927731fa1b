#include <gtest/gtest.h>

#include "morphbake/correspondence/check_map.h"
#include "morphbake/correspondence/source_topology.h"
#include "morphbake/correspondence/spherical_map.h"
#include "morphbake/diagnostics/problem.h"
#include "shapes/surfaces.h"

namespace morphbake {
namespace {

using test::kAxes;
using test::surface;
using test::two_spheres;

std::string code_of(const std::vector<SourceSurface>& sources) {
  try {
    map_to_sphere(sources, {});
  } catch (const BakeError& error) {
    return error.problems().front().code;
  }
  return "";
}

TEST(MapToSphere, RefusesHandlesPiecesAndHoles) {
  std::vector<SourceSurface> sources = two_spheres();
  sources[1] = surface("torus", test::torus(12, 16), kAxes);
  EXPECT_EQ(code_of(sources), "correspondence.handles");
  sources[1] = surface("two", test::joined(test::sphere(5, 6), test::tetrahedron()), kAxes);
  EXPECT_EQ(code_of(sources), "correspondence.pieces");
  sources[1] = surface("disk", test::grid(6, 6), kAxes);
  EXPECT_EQ(code_of(sources), "correspondence.different-topology");
}

TEST(MapToSphere, TellsAllThatIsWrongAtOnce) {
  std::vector<SourceSurface> sources = two_spheres();
  sources[0] = surface("disk", test::grid(6, 6), kAxes);
  sources.push_back(surface("two", test::joined(test::torus(12, 16), test::tetrahedron()), kAxes));
  std::vector<std::string> codes;
  for (const Problem& problem : topology_problems(sources)) codes.push_back(problem.code);
  EXPECT_EQ(codes, (std::vector<std::string>{"correspondence.different-topology",
                                             "correspondence.pieces", "correspondence.handles"}));
}

TEST(MapToSphere, NamesAMirrorImage) {
  std::vector<SourceSurface> sources = two_spheres();
  sources[1] = surface("mirrored", test::sphere(17, 23),
                       {{-1, 0.1, 0.2}, {0.2, 1, 0.1}, {-0.1, 0.2, 1}, {1, 0.2, -0.1}});
  EXPECT_EQ(code_of(sources), "correspondence.mirrored");
}

TEST(MapToSphere, RefusesLandmarksInOnePlace) {
  std::vector<SourceSurface> sources = two_spheres();
  sources[0].landmarks[1] = sources[0].landmarks[0];
  EXPECT_EQ(code_of(sources), "correspondence.same-landmark");
}

TEST(MapToSphere, LaysClosedSurfacesBijectively) {
  const std::vector<SourceSurface> sources = two_spheres();
  const std::vector<SphericalMap> maps = map_to_sphere(sources, {});
  for (std::size_t s = 0; s < 2; ++s) {
    const SphereCheck check = check_sphere(maps[s].sphere, maps[s].surface.triangles, false);
    EXPECT_EQ(check.turned, 0);
    EXPECT_NEAR(check.degree, 1, 1e-9);
    // Landmarks are new vertices inside of triangles.
    EXPECT_EQ(maps[s].surface.positions.rows(), sources[s].mesh.positions.rows() + 4);
    for (std::size_t l = 0; l < 4; ++l) {
      EXPECT_EQ(maps[s].sphere.row(maps[s].landmarks[l]), maps[0].sphere.row(maps[0].landmarks[l]));
    }
  }
}

}  // namespace
}  // namespace morphbake
