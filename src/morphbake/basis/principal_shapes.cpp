#include "morphbake/basis/principal_shapes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace morphbake {
namespace {

/// Inner products of all frames' displacements.
Eigen::MatrixXd gram_matrix(const FrameSource& frames, const Observer& observer) {
  const auto count = static_cast<Eigen::Index>(frames.times.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count);
  std::vector<Eigen::MatrixXd> of_part(block_ranges(frames).size());
  for_each_block(
      frames, observer,
      [&](std::size_t part, const FrameBlock& block) {
        of_part[part] = Eigen::MatrixXd::Zero(count, count);
        of_part[part].selfadjointView<Eigen::Lower>().rankUpdate(block);
      },
      [&](std::size_t part) {
        gram += of_part[part];
        of_part[part].resize(0, 0);
      });
  return gram;
}

/// Orthonormal directions among the frames, what tells most first; each with its largest number
/// above zero, so that they are the same wherever they are computed.
Eigen::MatrixXd directions_of(const Eigen::MatrixXd& gram) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);  // reads the lower triangle
  Eigen::MatrixXd directions = solver.eigenvectors().rowwise().reverse();
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    Eigen::Index at = 0;
    directions.col(k).cwiseAbs().maxCoeff(&at);
    if (directions(at, k) < 0) directions.col(k) *= -1;
  }
  return directions;
}

/// How far each vertex is at most from what the first `count` directions tell.
Eigen::VectorXd distances_from(const FrameBlock& block, const Eigen::MatrixXd& directions,
                               Eigen::Index count) {
  const auto first = directions.leftCols(count);
  const FrameBlock shapes = first.transpose() * block;
  const FrameBlock off = block - first * shapes;
  Eigen::VectorXd squared = Eigen::VectorXd::Zero(block.cols() / 3);
  for (Eigen::Index f = 0; f < off.rows(); ++f) {
    const double* row = off.row(f).data();
    for (Eigen::Index v = 0; v < squared.size(); ++v, row += 3) {
      squared(v) = std::max(squared(v), row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
    }
  }
  return squared.cwiseSqrt();
}

/// The fewest directions that keep all vertices of a block within the tolerance.
Eigen::Index fewest(const FrameBlock& block, const Eigen::MatrixXd& directions, double tolerance) {
  Eigen::Index bad = -1, good = directions.cols();  // all of them leave rounding only
  while (good - bad > 1) {
    const Eigen::Index count = bad + (good - bad) / 2;
    const bool keeps = distances_from(block, directions, count).maxCoeff() <= tolerance;
    (keeps ? good : bad) = count;
  }
  return good;
}

Eigen::Index fewest_for_all(const FrameSource& frames, const Eigen::MatrixXd& directions,
                            double tolerance, const Observer& observer) {
  std::vector<Eigen::Index> seen = spread_vertices(frames);
  while (true) {
    const Eigen::Index count = fewest(read_vertices(frames, seen), directions, tolerance);
    if (count == directions.cols()) return count;
    const std::vector<Eigen::Index> left = strays(
        frames, [&](const FrameBlock& block) { return distances_from(block, directions, count); },
        tolerance, observer);
    if (left.empty()) return count;
    seen.insert(seen.end(), left.begin(), left.end());
  }
}

}  // namespace

PrincipalShapes principal_shapes(const FrameSource& frames, double tolerance,
                                 const Observer& observer) {
  const Eigen::MatrixXd directions = directions_of(gram_matrix(frames, observer));
  const Eigen::Index count = fewest_for_all(frames, directions, tolerance, observer);
  PrincipalShapes principal;
  principal.weights = directions.leftCols(count);
  principal.shapes.assign(static_cast<std::size_t>(count), Positions(frames.vertex_count, 3));
  const std::vector<VertexRange> ranges = block_ranges(frames);
  for_each_block(
      frames, observer,
      [&](std::size_t part, const FrameBlock& block) {
        const FrameBlock rows = principal.weights.transpose() * block;
        const auto& [first, vertices] = ranges[part];
        for (Eigen::Index k = 0; k < count; ++k) {
          principal.shapes[static_cast<std::size_t>(k)].middleRows(first, vertices) =
              Eigen::Map<const Positions>(rows.row(k).data(), vertices, 3);
        }
      },
      [](std::size_t) {});
  return principal;
}

}  // namespace morphbake
