#include "morphbake/export/mesh_morph.h"

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

/// Least-squares fit of normal displacements to the weights over all frames.
std::vector<Normals> fit_normal_targets(const MorphableMesh& mesh, const MorphBasis& basis,
                                        const SmoothingGroups& groups,
                                        const std::vector<ReferenceMotion>& motions,
                                        const Eigen::Matrix3d& linear) {
  const auto target_count = static_cast<Eigen::Index>(basis.targets.size());
  if (target_count == 0) return {};
  const Normals rest = to_mesh_space(deformed_normals(groups, mesh, basis.base), linear);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(target_count, target_count);
  std::vector<Normals> moments(basis.targets.size(), Normals::Zero(groups.count, 3));
  const auto add = [&](const Eigen::VectorXd& w, const ReferenceMotion& motion, double time) {
    gram += w * w.transpose();
    if (w.isZero(0)) return;
    const Positions positions = motion.positions_at(time);
    const Normals difference =
        to_mesh_space(deformed_normals(groups, mesh, positions), linear) - rest;
    for (Eigen::Index k = 0; k < target_count; ++k) {
      if (w(k) != 0) moments[static_cast<std::size_t>(k)] += w(k) * difference;
    }
  };
  for (std::size_t c = 0; c < motions.size(); ++c) {
    const WeightKeys& keys = basis.clips[c];
    for (const double time : motions[c].frame_times) {
      add(interpolate_keys(keys.times, keys.weights, time), motions[c], time);
    }
  }
  // Targets that never move, or move together, leave the Gram matrix singular: least norm then.
  const Eigen::MatrixXd inverse = gram.completeOrthogonalDecomposition().pseudoInverse();
  std::vector<Normals> fitted(basis.targets.size(), Normals::Zero(groups.count, 3));
  for (Eigen::Index k = 0; k < target_count; ++k) {
    for (Eigen::Index m = 0; m < target_count; ++m) {
      if (inverse(k, m) != 0) {
        fitted[static_cast<std::size_t>(k)] += inverse(k, m) * moments[static_cast<std::size_t>(m)];
      }
    }
  }
  return fitted;
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
void add_rest(const SourceMesh& first, const MorphableMesh& mesh, const SmoothingGroups& groups,
              const Positions& positions, MeshMorph& morph) {
  const Eigen::Matrix3d to_mesh = linear_part(first).inverse();
  const Positions moved = (positions - mesh.geometries[0]) * to_mesh.transpose();
  Normals normals;
  if (groups.count > 0) {
    normals = to_mesh_space(deformed_normals(groups, mesh, positions), linear_part(first));
  }
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
  add_rest(first, mesh, groups, basis.base, morph);
  const Eigen::Matrix3d linear = linear_part(first);
  const Eigen::Matrix3d to_mesh = linear.inverse();
  std::vector<Normals> normals;
  if (groups.count > 0) normals = fit_normal_targets(mesh, basis, groups, motions, linear);
  for (std::size_t k = 0; k < basis.targets.size(); ++k) {
    morph.target_names.push_back(basis.targets[k].name);
    const Positions displacement = basis.targets[k].displacement * to_mesh.transpose();
    Eigen::Index begin = 0;
    for (PrimitiveMorph& primitive : morph.primitives) {
      const Eigen::Index count = primitive.positions.rows();
      primitive.target_positions.push_back(
          spread(displacement, mesh.vertex_of_render, begin, count));
      if (groups.count > 0) {
        primitive.target_normals.push_back(spread(normals[k], groups.of_render, begin, count));
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
  add_rest(first, mesh, groups, positions, morph);
  return morph;
}

}  // namespace morphbake
