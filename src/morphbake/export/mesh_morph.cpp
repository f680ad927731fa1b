#include "morphbake/export/mesh_morph.h"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <utility>

namespace morphbake {
namespace {

Eigen::Matrix3d linear_part(const SourceMesh& first) {
  return first.geometry.to_scene.topLeftCorner<3, 3>();
}

/// Normals of groups in mesh space, unit length.
Normals to_mesh_space(const Normals& scene_normals, const Eigen::Matrix3d& linear) {
  return (scene_normals * linear).rowwise().normalized();
}

/// Normals of groups in mesh space, as glTF morphs them: rest + sum_k w_k target_k.
struct NormalBasis {
  Normals rest;
  std::vector<Normals> targets;
};

using NormalRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sums over all frames of a least-squares fit of normals to the weights.
struct NormalMoments {
  Eigen::MatrixXd gram;  ///< #numbers by #numbers: the weights, and 1 where rest is fitted too
  NormalRows sums;       ///< #numbers by 3 #groups
};

NormalMoments normal_moments(const MorphableMesh& mesh, const MorphBasis& basis,
                             const SmoothingGroups& groups,
                             const std::vector<ReferenceMotion>& motions,
                             const Eigen::Matrix3d& linear, const Normals& rest) {
  const auto targets = static_cast<Eigen::Index>(basis.targets.size());
  const Eigen::Index count = targets + (basis.kind == TargetKind::Basis ? 1 : 0);
  NormalMoments moments{Eigen::MatrixXd::Zero(count, count),
                        NormalRows::Zero(count, 3 * Eigen::Index{groups.count})};
  Eigen::VectorXd numbers = Eigen::VectorXd::Ones(count);
  for (std::size_t c = 0; c < motions.size(); ++c) {
    const WeightKeys& keys = basis.clips[c];
    for (const double time : motions[c].frame_times) {
      numbers.head(targets) = interpolate_keys(keys.times, keys.weights, time);
      moments.gram += numbers * numbers.transpose();
      if (numbers.isZero(0)) continue;
      const Positions positions = motions[c].positions_at(time);
      const Normals difference =
          to_mesh_space(deformed_normals(groups, mesh, positions), linear) - rest;
      const Eigen::Map<const Eigen::RowVectorXd> row(difference.data(), difference.size());
      for (Eigen::Index k = 0; k < count; ++k) {
        if (numbers(k) != 0) moments.sums.row(k) += numbers(k) * row;
      }
    }
  }
  return moments;
}

/// rows <- matrix rows. Of frames that fade into one another the matrix is nearly empty.
void apply(const Eigen::MatrixXd& matrix, NormalRows& rows) {
  constexpr Eigen::Index kColumns = 1024;  // at once: they stay in caches
  const Eigen::Index parts = (rows.cols() + kColumns - 1) / kColumns;
  tbb::parallel_for(Eigen::Index{0}, parts, [&](Eigen::Index part) {
    const Eigen::Index first = part * kColumns;
    const Eigen::Index columns = std::min(kColumns, rows.cols() - first);
    const NormalRows old = rows.middleCols(first, columns);
    rows.middleCols(first, columns).setZero();
    for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
      for (Eigen::Index m = 0; m < matrix.cols(); ++m) {
        if (matrix(k, m) != 0) rows.row(k).segment(first, columns) += matrix(k, m) * old.row(m);
      }
    }
  });
}

/// Shaders norm what they morph: each group may have its own scale, so that its rest is a unit
/// normal, as glTF wants it.
void scale_to_unit_rest(const Normals& fitted, NormalBasis& normals) {
  constexpr double kShortest = 1e-6;
  for (Eigen::Index g = 0; g < fitted.rows(); ++g) {
    const double length = fitted.row(g).norm();
    if (!(length > kShortest)) continue;  // the fit says nothing: rest stays the surface's normal
    normals.rest.row(g) = fitted.row(g) / length;
    for (Normals& target : normals.targets) target.row(g) /= length;
  }
}

/// Least-squares fit of the deformed normals to the weights over all frames. Where the base is no
/// frame, rest is fitted as well: no normal of a frame is to be kept.
NormalBasis fit_normals(const MorphableMesh& mesh, const MorphBasis& basis,
                        const SmoothingGroups& groups, const std::vector<ReferenceMotion>& motions,
                        const Eigen::Matrix3d& linear) {
  NormalBasis normals{to_mesh_space(deformed_normals(groups, mesh, basis.base), linear), {}};
  if (basis.targets.empty()) return normals;
  NormalMoments moments = normal_moments(mesh, basis, groups, motions, linear, normals.rest);
  // Targets that never move, or move together, leave the Gram matrix singular: least norm then.
  const Eigen::MatrixXd inverse = moments.gram.completeOrthogonalDecomposition().pseudoInverse();
  apply(inverse, moments.sums);
  const auto rows_of = [&](Eigen::Index number) {
    return Eigen::Map<const Normals>(moments.sums.row(number).data(), groups.count, 3);
  };
  for (std::size_t k = 0; k < basis.targets.size(); ++k) {
    normals.targets.emplace_back(rows_of(static_cast<Eigen::Index>(k)));
  }
  if (basis.kind == TargetKind::Basis) {
    scale_to_unit_rest(normals.rest + rows_of(moments.sums.rows() - 1), normals);
  }
  return normals;
}

/// Rows of `of_vertex` for the render vertices begin, begin + 1, ...; zero for those that no
/// triangle uses.
template <typename Rows>
Float3s spread(const Rows& of_vertex, const std::vector<int>& index, Eigen::Index begin,
               Eigen::Index count) {
  Float3s rows = Float3s::Zero(count, 3);
  for (Eigen::Index r = 0; r < count; ++r) {
    const int vertex = index[static_cast<std::size_t>(begin + r)];
    if (vertex >= 0) rows.row(r) = of_vertex.row(vertex).template cast<float>();
  }
  return rows;
}

MeshMorph empty_morph(const SourceMesh& first) {
  MeshMorph morph;
  morph.node = first.geometry.node;
  morph.mesh = first.geometry.mesh;
  morph.drops_skin = first.geometry.is_posed;
  return morph;
}

/// Adds rest geometry: the file's own numbers, moved by how far `positions` are from the source's.
///
/// @param normals  of the groups there, mesh space
void add_rest(const SourceMesh& first, const MorphableMesh& mesh, const SmoothingGroups& groups,
              const Positions& positions, const Normals& normals, MeshMorph& morph) {
  const Eigen::Matrix3d to_mesh = linear_part(first).inverse();
  const Positions moved = (positions - mesh.geometries[0]) * to_mesh.transpose();
  const bool is_source = moved.isZero(0);  // then the file's own normals stand too, bit for bit
  morph.replaces_base = !is_source || !first.geometry.is_at_rest;
  Eigen::Index begin = 0;
  for (const PrimitiveGeometry& source : first.geometry.primitives) {
    const Eigen::Index count = source.positions.rows();
    PrimitiveMorph& primitive = morph.primitives.emplace_back();
    primitive.positions = source.positions;
    primitive.is_used.resize(static_cast<std::size_t>(count), false);
    if (groups.count > 0) primitive.normals = source.normals;
    for (Eigen::Index r = 0; r < count; ++r) {
      const auto render = static_cast<std::size_t>(begin + r);
      const int vertex = mesh.vertex_of_render[render];
      primitive.is_used[static_cast<std::size_t>(r)] = vertex >= 0;
      if (vertex < 0 || is_source) continue;
      primitive.positions.row(r) =
          (source.positions.row(r).cast<double>() + moved.row(vertex)).cast<float>();
      if (groups.count > 0)
        primitive.normals.row(r) = normals.row(groups.of_render[render]).cast<float>();
    }
    begin += count;
  }
}

}  // namespace

ReferenceMotion continuous_motion(const SolvedShapes& shapes, const SeparableTimeline& separable,
                                  const Timeline& timeline) {
  return {frame_times(timeline), [&](double time) {
            return combine_shapes(shapes, field_coefficients(timeline, separable, time));
          }};
}

ReferenceMotion stepped_motion(const FrameSource& frames) {
  return {frames.times, [&frames](double time) -> Positions {
            const std::vector<double>& times = frames.times;
            const auto next = std::lower_bound(times.begin(), times.end(), time);
            if (next == times.end()) return frames.positions(times.size() - 1);
            const auto frame = static_cast<std::size_t>(next - times.begin());
            if (*next == time || frame == 0) return frames.positions(frame);
            const double share = (time - times[frame - 1]) / (*next - times[frame - 1]);
            return (1 - share) * frames.positions(frame - 1) + share * frames.positions(frame);
          }};
}

ReferenceMotion motion_of(const ReferenceMotion& motion, const Clip& clip) {
  ReferenceMotion part;
  part.name = clip.name;
  part.frame_times.push_back(0);
  for (const double time : motion.frame_times) {
    if (time > clip.begin && time < clip.end) part.frame_times.push_back(time - clip.begin);
  }
  part.frame_times.push_back(clip.end - clip.begin);
  part.positions_at = [&motion, begin = clip.begin](double time) {
    return motion.positions_at(begin + time);
  };
  return part;
}

MeshMorph make_mesh_morph(const SourceMesh& first, const MorphableMesh& mesh,
                          const MorphBasis& basis, const SmoothingGroups& groups,
                          const std::vector<ReferenceMotion>& motions) {
  MeshMorph morph = empty_morph(first);
  const Eigen::Matrix3d linear = linear_part(first);
  const Eigen::Matrix3d to_mesh = linear.inverse();
  NormalBasis normals;
  if (groups.count > 0) normals = fit_normals(mesh, basis, groups, motions, linear);
  add_rest(first, mesh, groups, basis.base, normals.rest, morph);
  for (std::size_t k = 0; k < basis.targets.size(); ++k) {
    morph.target_names.push_back(basis.targets[k].name);
    const Positions displacement = basis.targets[k].displacement * to_mesh.transpose();
    Eigen::Index begin = 0;
    for (PrimitiveMorph& primitive : morph.primitives) {
      const Eigen::Index count = primitive.positions.rows();
      primitive.target_positions.push_back(
          spread(displacement, mesh.vertex_of_render, begin, count));
      if (groups.count > 0) {
        primitive.target_normals.push_back(spread(normals.targets[k], groups.of_render, begin, count));
      }
      begin += count;
    }
  }
  for (std::size_t c = 0; c < motions.size(); ++c) {
    morph.clips.push_back({motions[c].name, basis.clips[c].times, basis.clips[c].weights});
  }
  return morph;
}

MeshMorph make_still(const SourceMesh& first, const MorphableMesh& mesh,
                     const SmoothingGroups& groups, const Positions& positions) {
  MeshMorph morph = empty_morph(first);
  Normals normals;
  if (groups.count > 0) {
    normals = to_mesh_space(deformed_normals(groups, mesh, positions), linear_part(first));
  }
  add_rest(first, mesh, groups, positions, normals, morph);
  return morph;
}

}  // namespace morphbake
