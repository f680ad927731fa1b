#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "morphbake/basis/keyframes.h"
#include "morphbake/basis/morph_basis.h"
#include "morphbake/basis/principal_shapes.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

using testing::ElementsAre;

const Observer kNobody;

/// Frames that are in memory, one a tenth of a second.
FrameSource frames_of(std::vector<Positions> frames) {
  FrameSource source;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    source.times.push_back(0.1 * static_cast<double>(f));
  }
  source.vertex_count = frames.front().rows();
  source.rows = [frames = std::move(frames)](const FramePart& part) -> Positions {
    return frames[part.frame].middleRows(part.first, part.count);
  };
  return source;
}

/// Every vertex somewhere, and moved by path(frame, vertex).
template <typename Path>
FrameSource moving(int frames, int vertices, const Path& path) {
  std::vector<Positions> all;
  for (int f = 0; f < frames; ++f) {
    Positions& frame = all.emplace_back(vertices, 3);
    for (int v = 0; v < vertices; ++v) {
      frame.row(v) =
          Eigen::RowVector3d(std::sin(v), std::cos(3.0 * v), std::sin(7.0 * v)) + path(f, v);
    }
  }
  return frames_of(std::move(all));
}

/// A bump that runs over the vertices: its frames lie on no straight way and in no small space.
FrameSource bump(int frames = 41, int vertices = 300) {
  return moving(frames, vertices, [=](int f, int v) {
    const double off = 6 * (1.0 * v / vertices - 1.0 * f / frames);
    return Eigen::RowVector3d(0, 0, std::exp(-off * off));
  });
}

std::vector<Clip> whole(const FrameSource& frames) { return {{"all", 0, frames.times.back()}}; }

Positions shown_at(const MorphBasis& basis, double time) {
  const Eigen::VectorXd weights =
      interpolate_keys(basis.clips[0].times, basis.clips[0].weights, time);
  Positions positions = basis.base;
  for (std::size_t k = 0; k < basis.targets.size(); ++k) {
    positions += weights(static_cast<Eigen::Index>(k)) * basis.targets[k].displacement;
  }
  return positions;
}

double largest_error(const MorphBasis& basis, const FrameSource& frames) {
  double error = 0;
  for (std::size_t f = 0; f < frames.times.size(); ++f) {
    error =
        std::max(error, largest_distance(shown_at(basis, frames.times[f]), frames.positions(f)));
  }
  return error;
}

TEST(Keyframes, AreTheCornersOfStraightWays) {
  const FrameSource frames = moving(31, 50, [](int f, int v) {
    const double way = f < 7 ? f : f < 20 ? 7 - 2.0 * (f - 7) : -19 + 0.5 * (f - 20);
    return Eigen::RowVector3d(way, way * v, -way);
  });
  EXPECT_THAT(choose_keyframes(frames, 1e-9, kNobody), ElementsAre(0, 7, 20, 30));
}

TEST(Keyframes, AreAsFewAsAnyThatKeepTheTolerance) {
  const FrameSource frames = bump();
  const FrameBlock block = read_block(frames, {0, frames.vertex_count});
  const auto keeps = [&](std::size_t from, std::size_t to, double tolerance) {
    for (std::size_t at = from + 1; at < to; ++at) {
      const double share = static_cast<double>(at - from) / static_cast<double>(to - from);
      const Eigen::RowVectorXd off = block.row(static_cast<Eigen::Index>(at)) -
                                     (1 - share) * block.row(static_cast<Eigen::Index>(from)) -
                                     share * block.row(static_cast<Eigen::Index>(to));
      const Eigen::Map<const Positions> rows(off.data(), frames.vertex_count, 3);
      if (rows.rowwise().norm().maxCoeff() > tolerance) return false;
    }
    return true;
  };
  for (const double tolerance : {0.3, 0.1, 0.02, 0.003}) {
    // Fewest by dynamic programming.
    std::vector<std::size_t> fewest(frames.times.size(), 0);
    for (std::size_t to = 1; to < fewest.size(); ++to) {
      fewest[to] = fewest[to - 1] + 1;
      for (std::size_t from = 0; from < to; ++from) {
        if (fewest[from] + 1 < fewest[to] && keeps(from, to, tolerance)) {
          fewest[to] = fewest[from] + 1;
        }
      }
    }
    const std::vector<std::size_t> keys = choose_keyframes(frames, tolerance, kNobody);
    EXPECT_EQ(keys.size() - 1, fewest.back()) << tolerance;
    for (std::size_t k = 1; k < keys.size(); ++k) {
      EXPECT_TRUE(keeps(keys[k - 1], keys[k], tolerance));
    }
  }
}

TEST(Keyframes, SeeTheOneVertexThatTurnsBack) {
  constexpr int kVertices = 30000, kOne = 12347;
  const FrameSource frames = moving(25, kVertices, [](int f, int v) {
    return Eigen::RowVector3d(v == kOne && f == 13 ? 1 : 0, 0, 0.01 * f);
  });
  EXPECT_THAT(choose_keyframes(frames, 1e-3, kNobody), ElementsAre(0, 12, 13, 14, 24));
}

TEST(KeyframeBasis, KeepsTheTolerance) {
  const FrameSource frames = bump();
  for (const double tolerance : {0.1, 0.01}) {
    const MorphBasis basis = keyframe_basis(frames, tolerance, whole(frames), kNobody);
    EXPECT_LE(largest_error(basis, frames), tolerance + 1e-6);
    EXPECT_LT(basis.targets.size(), 40U);
    EXPECT_EQ(basis.base, frames.positions(0));
  }
}

TEST(KeyframeBasis, WhatComesBackSharesItsTargets) {
  const FrameSource frames = moving(21, 40, [](int f, int) {
    const double way[] = {0, 1, 3, 1, 0};
    return Eigen::RowVector3d((1 - f % 5 / 5.0) * way[f / 5] + f % 5 / 5.0 * way[(f / 5 + 1) % 5],
                              0, 0);
  });
  const MorphBasis basis = keyframe_basis(frames, 1e-6, whole(frames), kNobody);
  EXPECT_EQ(basis.targets.size(), 2U) << "of keys at 0, 5, 10, 15 and 20 three are the first";
  EXPECT_LT(largest_error(basis, frames), 1e-6);
}

TEST(PrincipalBasis, HasTheRankOfTheMotion) {
  const FrameSource frames = moving(30, 500, [](int f, int v) {
    return Eigen::RowVector3d(std::sin(0.3 * f) * std::sin(v), (std::cos(0.5 * f) - 1) * v / 500,
                              std::sin(1.1 * f) * std::cos(2.0 * v));
  });
  const MorphBasis basis = principal_basis(frames, 1e-5, whole(frames), kNobody);
  EXPECT_EQ(basis.targets.size(), 3U);
  EXPECT_LT(largest_error(basis, frames), 1e-5);
}

TEST(PrincipalBasis, WeightsRunFromZeroToOne) {
  const FrameSource frames = bump();
  const MorphBasis basis = principal_basis(frames, 0.01, whole(frames), kNobody);
  const Eigen::MatrixXf& weights = basis.clips[0].weights;
  for (Eigen::Index k = 0; k < weights.cols(); ++k) {
    EXPECT_EQ(weights.col(k).minCoeff(), 0);
    EXPECT_EQ(weights.col(k).maxCoeff(), 1);
  }
  EXPECT_LT(largest_distance(shown_at(basis, 0), frames.positions(0)), 1e-6);
}

TEST(PrincipalBasis, NeedsNoMoreThanTheTruncatedDecomposition) {
  const FrameSource frames = bump();
  const Eigen::MatrixXd block = read_block(frames, {0, frames.vertex_count});
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(block, Eigen::ComputeThinU | Eigen::ComputeThinV);
  for (const double tolerance : {0.1, 0.01, 1e-4, 1e-6}) {
    Eigen::Index rank = 0;
    for (double error = 1e9; error > tolerance; ++rank) {
      const FrameBlock off = block - svd.matrixU().leftCols(rank + 1) *
                                         svd.singularValues().head(rank + 1).asDiagonal() *
                                         svd.matrixV().leftCols(rank + 1).transpose();
      const Eigen::Map<const Positions> rows(off.data(), off.size() / 3, 3);
      error = rows.rowwise().norm().maxCoeff();
    }
    const PrincipalShapes principal = principal_shapes(frames, tolerance, kNobody);
    EXPECT_EQ(static_cast<Eigen::Index>(principal.shapes.size()), rank) << tolerance;
  }
}

TEST(PrincipalBasis, SeesTheOneVertexThatMovesByItself) {
  constexpr int kVertices = 30000, kOne = 12347;
  const FrameSource frames = moving(25, kVertices, [](int f, int v) {
    return Eigen::RowVector3d(v == kOne ? std::sin(0.7 * f) * 0.01 : 0, 0, 0.1 * f);
  });
  EXPECT_EQ(principal_basis(frames, 1e-3, whole(frames), kNobody).targets.size(), 2U);
}

TEST(PrincipalBasis, WhatNeverMovesStaysExactly) {
  const FrameSource frames = moving(25, 300, [](int f, int v) {
    return Eigen::RowVector3d(v % 2 * std::sin(0.2 * f * v), 0, 0);
  });
  const MorphBasis basis = principal_basis(frames, 1e-3, whole(frames), kNobody);
  const Positions rest = frames.positions(0);
  for (Eigen::Index v = 0; v < 300; v += 2) {
    EXPECT_EQ(basis.base.row(v), rest.row(v));
    for (const MorphTarget& target : basis.targets) {
      EXPECT_TRUE(target.displacement.row(v).isZero(0));
    }
  }
}

TEST(PrincipalBasis, NothingMovesWithoutTargets) {
  const FrameSource frames = moving(5, 20, [](int, int) { return Eigen::RowVector3d(0, 0, 0); });
  EXPECT_TRUE(principal_basis(frames, 1e-3, whole(frames), kNobody).targets.empty());
  EXPECT_TRUE(keyframe_basis(frames, 1e-3, whole(frames), kNobody).targets.empty());
}

TEST(PrincipalBasis, IsTheSameOnAnyNumberOfThreads) {
  const FrameSource frames = bump(60, 40000);
  const MorphBasis many = principal_basis(frames, 1e-3, whole(frames), kNobody);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const MorphBasis single = principal_basis(frames, 1e-3, whole(frames), kNobody);
  ASSERT_EQ(many.targets.size(), single.targets.size());
  EXPECT_EQ(many.base, single.base);
  for (std::size_t k = 0; k < many.targets.size(); ++k) {
    EXPECT_EQ(many.targets[k].displacement, single.targets[k].displacement);
  }
}

}  // namespace
}  // namespace morphbake
