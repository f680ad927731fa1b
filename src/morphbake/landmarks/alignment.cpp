#include "morphbake/landmarks/alignment.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "morphbake/landmarks/assignment.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

// Of the squares of differences; positions are in boxes of half size 1, distances in `reach`.
constexpr double kPlaceWeight = 0.3;
constexpr double kMeanWeight = 1.0;
constexpr double kPairWeight = 1.0;
constexpr double kAloneInPose = 0.02;  // without places: an arm may hang or be stretched out
constexpr double kPairLimit = 0.3;     // a tail that is far too long shall not spoil all others
constexpr double kAlone = 0.25;        // a tip without partner; two such cost more than a bad pair
constexpr double kAloneAtLast = 0.4;
constexpr std::size_t kFewestToCompare = 2;
constexpr int kRounds = 6;
constexpr double kTurnPrior = 0.1;      // of half a turn
constexpr double kUprightPrior = 0.25;  // of standing on the head
constexpr int kSurfaceSamples = 400;
constexpr int kSurfaceRounds = 12;

/// Distance between two tips of a shape.
double between(const ShapeSketch& shape, int i, int j) {
  return shape.from_tip[static_cast<std::size_t>(i)](
      shape.tips[static_cast<std::size_t>(j)].vertex);
}

Eigen::Vector3d tip_position(const ShapeSketch& shape, int tip) {
  return shape.mesh.positions.row(shape.tips[static_cast<std::size_t>(tip)].vertex);
}

/// Cost of each pair of tips by itself.
Eigen::MatrixXd single_costs(const ShapeSketch& a, const ShapeSketch& b, const Frame& frame_a,
                             const Frame& frame_b, double place_weight) {
  const auto rows = static_cast<int>(a.tips.size()), columns = static_cast<int>(b.tips.size());
  Eigen::MatrixXd cost(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double apart =
          (frame_a.in_box(tip_position(a, i)) - frame_b.in_box(tip_position(b, j))).squaredNorm();
      const double mean = a.mean_distance(a.tips[static_cast<std::size_t>(i)].vertex) -
                          b.mean_distance(b.tips[static_cast<std::size_t>(j)].vertex);
      cost(i, j) = place_weight * apart + kMeanWeight * mean * mean;
    }
  }
  return cost;
}

/// `single` and how well the distances to all partners agree.
Eigen::MatrixXd with_pairs(const ShapeSketch& a, const ShapeSketch& b,
                           const Eigen::MatrixXd& single, const std::vector<int>& partner) {
  Eigen::MatrixXd cost = single;
  for (int i = 0; i < cost.rows(); ++i) {
    for (int j = 0; j < cost.cols(); ++j) {
      double sum = 0;
      int count = 0;
      for (std::size_t k = 0; k < partner.size(); ++k) {
        const int l = partner[k];
        // Its own pair says nothing about it.
        if (l < 0 || (static_cast<int>(k) == i && l == j)) continue;
        const double difference = between(a, static_cast<int>(k), i) - between(b, l, j);
        sum += std::min(difference * difference, kPairLimit);
        ++count;
      }
      if (count > 0) cost(i, j) += kPairWeight * sum / count;
    }
  }
  return cost;
}

/// What an assignment costs: a mean over the tips of both shapes.
double mean_cost(const Eigen::MatrixXd& cost, const std::vector<int>& partner) {
  double sum = 0;
  Eigen::Index alone = cost.rows() + cost.cols();
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] < 0) continue;
    sum += cost(static_cast<Eigen::Index>(i), partner[i]);
    alone -= 2;
  }
  const auto all = static_cast<double>(cost.rows() + cost.cols());
  return all > 0 ? (sum + kAlone * static_cast<double>(alone)) * 2 / all : 0;
}

/// The 24 turns of a cube, or the 24 mirrored ones, the unit matrix (or its mirror) first.
std::vector<Eigen::Matrix3d> signed_permutations(Handedness handedness) {
  const double determinant = handedness == Handedness::Kept ? 1 : -1;
  std::vector<Eigen::Matrix3d> all;
  Eigen::Vector3i order(0, 1, 2);
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
      for (int k = 0; k < 3; ++k) matrix(order(k), k) = (signs >> k & 1) != 0 ? -1 : 1;
      if (matrix.determinant() * determinant > 0) all.push_back(matrix);
    }
  } while (std::next_permutation(order.data(), order.data() + 3));
  return all;
}

/// What a turn from a to b costs when all else is equal.
double turn_prior(const Alignment& alignment, Handedness handedness) {
  Eigen::Matrix3d turn = alignment.b.axes * alignment.a.axes.transpose();
  if (handedness == Handedness::Mirrored) turn.col(0) *= -1;
  const double angle = Eigen::AngleAxisd(turn).angle();
  return kTurnPrior * angle / M_PI + kUprightPrior * (1 - turn(1, 1)) / 2;
}

/// Centre and covariance of a surface's area.
std::pair<Eigen::Vector3d, Eigen::Matrix3d> centre_and_spread(const Mesh& mesh) {
  Eigen::VectorXd areas = vertex_areas(mesh.positions, mesh.triangles);
  if (!(areas.sum() > 0)) areas.setOnes();
  areas /= areas.sum();
  const Eigen::RowVector3d centre = areas.transpose() * mesh.positions;
  const Positions around = mesh.positions.rowwise() - centre;
  return {centre, around.transpose() * areas.asDiagonal() * around};
}

/// Rows of `mesh` that stand for its surface.
Positions surface_samples(const Mesh& mesh) {
  const Eigen::Index step = std::max<Eigen::Index>(1, mesh.positions.rows() / kSurfaceSamples);
  Positions samples((mesh.positions.rows() + step - 1) / step, 3);
  for (Eigen::Index i = 0; i < samples.rows(); ++i) samples.row(i) = mesh.positions.row(i * step);
  return samples;
}

/// Gives tips that have no partner one, by a cost that looks at places or does not.
void match_lonely(const ShapeSketch& a, const ShapeSketch& b, Alignment& alignment,
                  double place_weight, double alone) {
  std::vector<int>& partner = alignment.partner;
  std::vector<int> rows, columns;
  for (int i = 0; i < static_cast<int>(partner.size()); ++i) {
    if (partner[static_cast<std::size_t>(i)] < 0) rows.push_back(i);
  }
  for (int j = 0; j < static_cast<int>(b.tips.size()); ++j) {
    if (std::find(partner.begin(), partner.end(), j) == partner.end()) columns.push_back(j);
  }
  // Too little to compare with: any two tips would do.
  if (partner.size() < rows.size() + kFewestToCompare) return;
  const Eigen::MatrixXd single = single_costs(a, b, alignment.a, alignment.b, place_weight);
  const Eigen::MatrixXd cost = with_pairs(a, b, single, partner);
  const std::vector<int> found = assign(cost(rows, columns), alone);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] < 0) continue;
    partner[static_cast<std::size_t>(rows[i])] = columns[static_cast<std::size_t>(found[i])];
  }
}

}  // namespace

Frame frame_along(const Mesh& mesh, const Eigen::Matrix3d& axes) {
  constexpr double kThinnest = 0.2;
  const auto [centre, spread] = centre_and_spread(mesh);
  const Eigen::Vector3d size =
      2 * (axes.transpose() * spread * axes).diagonal().cwiseMax(0).cwiseSqrt();
  const double least = std::max(kThinnest * size.maxCoeff(), std::numeric_limits<double>::min());
  return {axes, centre, size.cwiseMax(least)};
}

Eigen::Matrix3d principal_axes(const Mesh& mesh) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(centre_and_spread(mesh).second);
  Eigen::Matrix3d axes = solver.eigenvectors().rowwise().reverse();
  if (axes.determinant() < 0) axes.col(2) *= -1;
  return axes;
}

Alignment align_in(const ShapeSketch& a, const ShapeSketch& b, const Frame& frame_a,
                   const Frame& frame_b) {
  const Eigen::MatrixXd single = single_costs(a, b, frame_a, frame_b, kPlaceWeight);
  Alignment best{frame_a, frame_b, assign(single, kAlone), 0};
  std::vector<int> partner = best.partner;
  best.cost = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::MatrixXd cost = with_pairs(a, b, single, partner);
    const double total = mean_cost(cost, partner);
    if (total < best.cost) {
      best.cost = total;
      best.partner = partner;
    }
    const std::vector<int> next = assign(cost, kAlone);
    if (next == partner) break;
    partner = next;
  }
  // Pairs that others do not agree with are none.
  const Eigen::MatrixXd cost = with_pairs(a, b, single, best.partner);
  for (std::size_t i = 0; i < best.partner.size(); ++i) {
    int& other = best.partner[i];
    if (other >= 0 && cost(static_cast<Eigen::Index>(i), other) > 2 * kAlone) other = -1;
  }
  return best;
}

Alignment align_shapes(const ShapeSketch& a, const ShapeSketch& b, Handedness handedness) {
  Alignment best;
  double least = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<Eigen::Matrix3d, Eigen::Matrix3d>> bases = {
      {Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()},
      {principal_axes(a.mesh), principal_axes(b.mesh)}};
  for (const auto& [axes_a, axes_b] : bases) {
    const Frame frame_a = frame_along(a.mesh, axes_a);
    for (const Eigen::Matrix3d& turn : signed_permutations(handedness)) {
      Alignment alignment = align_in(a, b, frame_a, frame_along(b.mesh, axes_b * turn));
      const double cost = alignment.cost + turn_prior(alignment, handedness);
      if (cost >= least) continue;
      least = cost;
      best = std::move(alignment);
    }
  }
  return best;
}

void match_rest(const ShapeSketch& a, const ShapeSketch& b, Alignment& alignment) {
  match_lonely(a, b, alignment, kPlaceWeight, kAloneAtLast);
  match_lonely(a, b, alignment, 0, kAloneInPose);
}

double surface_distance(const ShapeSketch& a, const ShapeSketch& b, const Alignment& alignment,
                        Handedness handedness) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double diagonal = bounding_diagonal(b.mesh.positions);
  // Umeyama finds motions only: a is mirrored first.
  Mesh mirrored = a.mesh;
  if (handedness == Handedness::Mirrored) mirrored.positions.col(0) *= -1;
  std::vector<int> rows_a, rows_b;
  for (std::size_t i = 0; i < alignment.partner.size(); ++i) {
    if (alignment.partner[i] < 0) continue;
    rows_a.push_back(a.tips[i].vertex);
    rows_b.push_back(b.tips[static_cast<std::size_t>(alignment.partner[i])].vertex);
  }
  if (rows_a.size() < 3 || !(diagonal > 0)) return infinity;
  Eigen::Matrix3Xd from = mirrored.positions(rows_a, Eigen::all).transpose();
  Eigen::Matrix3Xd to = b.mesh.positions(rows_b, Eigen::all).transpose();
  const Positions samples = surface_samples(mirrored);
  double best = infinity;
  for (int round = 0; round < kSurfaceRounds; ++round) {
    const Eigen::Matrix4d motion = Eigen::umeyama(from, to);
    const Positions moved = (samples * motion.topLeftCorner<3, 3>().transpose()).rowwise() +
                            motion.topRightCorner<3, 1>().transpose();
    if (!moved.allFinite()) return best;
    from = samples.transpose();
    to.resize(3, samples.rows());
    double sum = 0;
    const std::vector<SurfacePoint> closest = closest_points(b.mesh, moved);
    for (Eigen::Index i = 0; i < moved.rows(); ++i) {
      to.col(i) = position_of(b.mesh, closest[static_cast<std::size_t>(i)]);
      sum += (to.col(i) - moved.row(i).transpose()).norm();
    }
    best = std::min(best, sum / static_cast<double>(moved.rows()) / diagonal);
  }
  return best;
}

}  // namespace morphbake
