#include "morphbake/export/mesh_morph.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>
#include <utility>

#include "morphbake/export/render_tangents.h"

namespace morphbake {
namespace {

Eigen::Matrix3d linear_part(const SourceMesh& first) {
  return first.geometry.to_scene.topLeftCorner<3, 3>();
}

/// Normals of groups in mesh space, unit length.
Normals to_mesh_space(const Normals& scene_normals, const Eigen::Matrix3d& linear) {
  return (scene_normals * linear).rowwise().normalized();
}

FittedVectors fit_normals(const MorphableMesh& mesh, const MorphBasis& basis,
                          const SmoothingGroups& groups,
                          const std::vector<ReferenceMotion>& motions,
                          const Eigen::Matrix3d& linear, TargetRange range) {
  const auto normals_of = [&](const Positions& positions) {
    return to_mesh_space(deformed_normals(groups, mesh, positions), linear);
  };
  std::vector<VectorMotion> shown;
  for (const ReferenceMotion& motion : motions) {
    shown.push_back(
        {motion.frame_times, [&](double time) { return normals_of(motion.positions_at(time)); }});
  }
  return fit_directions(basis, normals_of(basis.base), shown, range);
}

/// Nothing where no normal map needs them.
std::optional<FittedVectors> fit_tangents(const SourceMesh& first, const MorphableMesh& mesh,
                                          const MorphBasis& basis, const SmoothingGroups& groups,
                                          const RenderTangents& tangents,
                                          const std::vector<ReferenceMotion>& motions) {
  if (tangents.in_file.rows() == 0) return {};
  const auto tangents_of = [&](const Positions& positions) {
    return deformed_tangents(tangents, first, groups, mesh, positions);
  };
  std::vector<VectorMotion> shown;
  for (const ReferenceMotion& motion : motions) {
    shown.push_back(
        {motion.frame_times, [&](double time) { return tangents_of(motion.positions_at(time)); }});
  }
  return fit_directions(basis, tangents_of(basis.base), shown, TargetRange::Any);
}

/// Nothing where colours do not change.
std::optional<FittedVectors> changing_colours(const MorphBasis& basis,
                                              const std::vector<ReferenceMotion>& motions) {
  if (!motions.front().colours_at) return {};
  std::vector<VectorMotion> shown;
  for (const ReferenceMotion& motion : motions) {
    shown.push_back({motion.frame_times, motion.colours_at});
  }
  return fit_colours(basis, motions.front().first_colours, shown);
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

/// @param directions  #R by 3, mesh space
void add_rest_tangents(const RenderTangents& tangents, const Positions& directions,
                       MeshMorph& morph) {
  Eigen::Index begin = 0;
  for (std::size_t p = 0; p < morph.primitives.size(); ++p) {
    PrimitiveMorph& primitive = morph.primitives[p];
    const Eigen::Index count = primitive.positions.rows();
    if (tangents.is_given[p]) {
      primitive.tangents = tangents.in_file.middleRows(begin, count);
      primitive.tangents.leftCols<3>() = directions.middleRows(begin, count).cast<float>();
    }
    begin += count;
  }
}

/// @param colours  #R by 3
void add_rest_colours(const Positions& colours, MeshMorph& morph) {
  Eigen::Index begin = 0;
  for (PrimitiveMorph& primitive : morph.primitives) {
    const Eigen::Index count = primitive.positions.rows();
    primitive.colours = colours.middleRows(begin, count).cast<float>();
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
  if (motion.colours_at) {
    part.colours_at = [&motion, begin = clip.begin](double time) {
      return motion.colours_at(begin + time);
    };
  }
  part.first_colours = motion.first_colours;
  return part;
}

MeshMorph make_mesh_morph(const SourceMesh& first, const MorphableMesh& mesh,
                          const MorphBasis& basis, const SmoothingGroups& groups,
                          const std::vector<ReferenceMotion>& motions, TargetRange normal_range) {
  MeshMorph morph = empty_morph(first);
  const Eigen::Matrix3d linear = linear_part(first);
  const Eigen::Matrix3d to_mesh = linear.inverse();
  FittedVectors normals;
  if (groups.count > 0) normals = fit_normals(mesh, basis, groups, motions, linear, normal_range);
  const RenderTangents tangents = find_tangents(first, mesh, groups);
  const std::optional<FittedVectors> directions =
      fit_tangents(first, mesh, basis, groups, tangents, motions);
  const std::optional<FittedVectors> colours = changing_colours(basis, motions);
  add_rest(first, mesh, groups, basis.base, normals.rest, morph);
  if (directions) add_rest_tangents(tangents, directions->rest, morph);
  if (colours) add_rest_colours(colours->rest, morph);
  for (std::size_t k = 0; k < basis.targets.size(); ++k) {
    morph.target_names.push_back(basis.targets[k].name);
    const Positions displacement = basis.targets[k].displacement * to_mesh.transpose();
    Eigen::Index begin = 0;
    for (std::size_t p = 0; p < morph.primitives.size(); ++p) {
      PrimitiveMorph& primitive = morph.primitives[p];
      const Eigen::Index count = primitive.positions.rows();
      primitive.target_positions.push_back(
          spread(displacement, mesh.vertex_of_render, begin, count));
      if (groups.count > 0) {
        primitive.target_normals.push_back(
            spread(normals.targets[k], groups.of_render, begin, count));
      }
      if (directions && tangents.is_given[p]) {
        primitive.target_tangents.emplace_back(
            directions->targets[k].middleRows(begin, count).cast<float>());
      }
      if (colours) {
        primitive.target_colours.emplace_back(
            colours->targets[k].middleRows(begin, count).cast<float>());
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
                     const SmoothingGroups& groups, const Positions& positions,
                     const Positions& colours) {
  MeshMorph morph = empty_morph(first);
  Normals normals;
  if (groups.count > 0) {
    normals = to_mesh_space(deformed_normals(groups, mesh, positions), linear_part(first));
  }
  add_rest(first, mesh, groups, positions, normals, morph);
  const RenderTangents tangents = find_tangents(first, mesh, groups);
  if (tangents.in_file.rows() > 0) {
    add_rest_tangents(tangents, deformed_tangents(tangents, first, groups, mesh, positions), morph);
  }
  if (colours.rows() > 0) add_rest_colours(colours, morph);
  return morph;
}

}  // namespace morphbake
