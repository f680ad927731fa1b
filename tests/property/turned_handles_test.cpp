#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_deformation.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "morphbake/derive/free_form.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr double kDegree = std::numbers::pi / 180;

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& f : mesh.triangles.rowwise()) {
    const Eigen::Vector3d a = mesh.positions.row(f(0)), b = mesh.positions.row(f(1)),
                          c = mesh.positions.row(f(2));
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

/// Root mean square of what edges are longer or shorter than before, relative.
double edge_error(const Mesh& before, const Positions& after) {
  double sum = 0;
  for (const auto& f : before.triangles.rowwise()) {
    for (int k = 0; k < 3; ++k) {
      const int a = f(k), b = f((k + 1) % 3);
      const double length = (before.positions.row(a) - before.positions.row(b)).norm();
      sum += std::pow((after.row(a) - after.row(b)).norm() / length - 1, 2);
    }
  }
  return std::sqrt(sum / static_cast<double>(before.triangles.size()));
}

/// A bar whose lower fifth is fixed and whose upper fifth is turned by a rotation about its middle.
struct TurnedBar {
  Mesh mesh = test::bar(20);
  std::vector<bool> fixed;
  Handle handle;

  TurnedBar(const Eigen::Vector3d& axis, double angle) {
    for (int v = 0; v < mesh.positions.rows(); ++v) {
      const double along = mesh.positions(v, 1);
      fixed.push_back(along < 0.2);
      if (along > 0.8) handle.vertices.push_back(v);
    }
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Positions rest = mesh.positions(handle.vertices, Eigen::all);
    const Eigen::RowVector3d middle = rest.colwise().mean();
    handle.positions = ((rest.rowwise() - middle) * turn.transpose()).rowwise() + middle;
    handle.turn = angle * axis;
  }

  Positions by(Surroundings surroundings) const {
    return free_form(mesh, fixed, {handle}, surroundings);
  }

  /// As CGAL deforms it, as rigidly as possible (Sorkine and Alexa 2007).
  Positions by_cgal() const {
    Surface surface;
    for (const auto& p : mesh.positions.rowwise()) surface.add_vertex({p(0), p(1), p(2)});
    const auto vertex = [](int v) { return Surface::Vertex_index(static_cast<unsigned>(v)); };
    for (const auto& f : mesh.triangles.rowwise()) {
      surface.add_face(vertex(f(0)), vertex(f(1)), vertex(f(2)));
    }
    CGAL::Surface_mesh_deformation<Surface> deformation(surface);
    for (int v = 0; v < mesh.positions.rows(); ++v) {
      deformation.insert_roi_vertex(vertex(v));
      if (fixed[static_cast<std::size_t>(v)]) deformation.insert_control_vertex(vertex(v));
    }
    for (const int v : handle.vertices) deformation.insert_control_vertex(vertex(v));
    EXPECT_TRUE(deformation.preprocess());
    for (std::size_t k = 0; k < handle.vertices.size(); ++k) {
      const auto p = handle.positions.row(static_cast<Eigen::Index>(k));
      deformation.set_target_position(vertex(handle.vertices[k]), {p(0), p(1), p(2)});
    }
    deformation.deform(500, 1e-6);
    Positions positions(mesh.positions.rows(), 3);
    for (int v = 0; v < positions.rows(); ++v) {
      const auto& p = surface.point(vertex(v));
      positions.row(v) << p.x(), p.y(), p.z();
    }
    return positions;
  }
};

struct Turn {
  Eigen::Vector3d axis;
  double degrees;
};

class TurnedHandles : public testing::TestWithParam<Turn> {};

TEST_P(TurnedHandles, KeepWhatIsBetweenAsWellAsArapDoes) {
  const TurnedBar bar(GetParam().axis, GetParam().degrees * kDegree);
  const Positions turned = bar.by(Surroundings::Turned), cgal = bar.by_cgal();
  const double whole = volume(bar.mesh);
  const auto loss = [&](const Positions& positions) {
    return std::abs(volume({positions, bar.mesh.triangles}) / whole - 1);
  };
  RecordProperty("edges", std::to_string(edge_error(bar.mesh, turned)));
  printf("edges %.4f (ARAP %.4f, as they are %.4f), volume %.4f (%.4f, %.4f)\n",
         edge_error(bar.mesh, turned), edge_error(bar.mesh, cgal),
         edge_error(bar.mesh, bar.by(Surroundings::AsTheyAre)), loss(turned), loss(cgal),
         loss(bar.by(Surroundings::AsTheyAre)));
  EXPECT_LT(edge_error(bar.mesh, turned), edge_error(bar.mesh, bar.by(Surroundings::AsTheyAre)));
}

INSTANTIATE_TEST_SUITE_P(FreeForm, TurnedHandles,
                         testing::Values(Turn{{0, 1, 0}, 120}, Turn{{1, 0, 0}, 60},
                                         Turn{{0, 1, 0}, 400}));

TEST(TurnedHandlesOf, NoTurnAreAsTheyAre) {
  TurnedBar bar(Eigen::Vector3d::UnitY(), 0);
  bar.handle.positions.rowwise() += Eigen::RowVector3d(0.1, 0, 0.05);
  EXPECT_EQ(bar.by(Surroundings::Turned), bar.by(Surroundings::AsTheyAre));
}

TEST(TurnedHandlesOf, AWholePieceTurnIt) {
  // Nothing is fixed: one handle turns and scales all of it.
  TurnedBar bar(Eigen::Vector3d(1, 2, 2) / 3, 150 * kDegree);
  bar.fixed.assign(bar.fixed.size(), false);
  const Eigen::Matrix3d map =
      1.5 * Eigen::AngleAxisd(150 * kDegree, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
  bar.handle.growth = 1.5;
  bar.handle.positions =
      Positions(bar.mesh.positions(bar.handle.vertices, Eigen::all)) * map.transpose();
  EXPECT_LT(largest_distance(bar.by(Surroundings::Turned), bar.mesh.positions * map.transpose()),
            1e-8);
}

}  // namespace
}  // namespace morphbake
