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

constexpr double kEnd = 0.2;  // of the bar
constexpr double kDegree = std::numbers::pi / 180;

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

  TurnedBar(double bend, double twist) {
    for (int v = 0; v < mesh.positions.rows(); ++v) {
      const double along = mesh.positions(v, 1);
      fixed.push_back(along < kEnd);
      if (along > 1 - kEnd) handle.vertices.push_back(v);
    }
    // Where an arc between the ends leads to, the upper end being straight.
    const double way = 1 - 2 * kEnd, angle = bend * way;
    const Eigen::AngleAxisd bent(-angle, Eigen::Vector3d::UnitZ());
    const Eigen::AngleAxisd twisted(twist, Eigen::Vector3d::UnitY());
    const Eigen::Matrix3d turn = (bent * twisted).toRotationMatrix();
    const double radius = bend == 0 ? 0 : 1 / bend;
    const Eigen::RowVector3d from(0, 1 - kEnd, 0);
    const Eigen::RowVector3d to = bend == 0
                                      ? from
                                      : Eigen::RowVector3d(radius * (1 - std::cos(angle)),
                                                           kEnd + radius * std::sin(angle), 0);
    const Positions rest = mesh.positions(handle.vertices, Eigen::all);
    handle.positions = ((rest.rowwise() - from) * turn.transpose()).rowwise() + to;
    // As vectors, so that a twist may be of more than half a turn.
    handle.turn = bend == 0 ? Eigen::Vector3d(0, twist, 0) : Eigen::Vector3d(0, 0, -angle);
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
  double bend = 0;   ///< degrees a unit of length
  double twist = 0;  ///< degrees
  double beside_cgal = 1;
};

class TurnedHandles : public testing::TestWithParam<Turn> {};

TEST_P(TurnedHandles, ShearNothing) {
  const TurnedBar bar(GetParam().bend * kDegree, GetParam().twist * kDegree);
  const Positions turned = bar.by(Surroundings::Turned), cgal = bar.by_cgal();
  const double whole = enclosed_volume(bar.mesh.positions, bar.mesh.triangles);
  const auto loss = [&](const Positions& positions) {
    return std::abs(enclosed_volume(positions, bar.mesh.triangles) / whole - 1);
  };
  const Positions sheared = bar.by(Surroundings::AsTheyAre);
  EXPECT_LT(edge_error(bar.mesh, turned), GetParam().beside_cgal * edge_error(bar.mesh, cgal));
  EXPECT_LT(edge_error(bar.mesh, turned), 0.5 * edge_error(bar.mesh, sheared));
  EXPECT_LT(loss(turned), 1.25 * loss(cgal));
}

INSTANTIATE_TEST_SUITE_P(FreeForm, TurnedHandles,
                         testing::Values(Turn{0, 120, 1.25}, Turn{150, 0, 1.25},
                                         Turn{0, 270, 2.5}));

TEST(TurnedHandlesOf, NoTurnAreAsTheyAre) {
  TurnedBar bar(0, 0);
  bar.handle.positions.rowwise() += Eigen::RowVector3d(0.1, 0, 0.05);
  EXPECT_EQ(bar.by(Surroundings::Turned), bar.by(Surroundings::AsTheyAre));
}

TEST(TurnedHandlesOf, AWholePieceTurnIt) {
  // Nothing is fixed: one handle turns and scales all of it.
  TurnedBar bar(0, 0);
  bar.handle.turn = 150 * kDegree * Eigen::Vector3d(1, 2, 2) / 3;
  bar.fixed.assign(bar.fixed.size(), false);
  const Eigen::Matrix3d map =
      1.5 * Eigen::AngleAxisd(150 * kDegree, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
  bar.handle.growth = 1.5;
  bar.handle.positions =
      Positions(bar.mesh.positions(bar.handle.vertices, Eigen::all)) * map.transpose();
  EXPECT_LT(largest_distance(bar.by(Surroundings::Turned), bar.mesh.positions * map.transpose()),
            1e-8);
}

TEST(FreeForm, RelaxingCanBeInterrupted) {
  const TurnedBar bar(0, 90 * kDegree);
  int asked = 0;
  Observer observer;
  observer.is_cancelled = [&asked] { return ++asked == 4; };  // some passes on
  EXPECT_THROW(free_form(bar.mesh, bar.fixed, {bar.handle}, Surroundings::Turned, observer),
               Cancelled);
}

}  // namespace
}  // namespace morphbake
