#include "morphbake/export/render_tangents.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "morphbake/gltf/vertex_attributes.h"

namespace morphbake {
namespace {

Eigen::Matrix3d linear_part(const SourceMesh& first) {
  return first.geometry.to_scene.topLeftCorner<3, 3>();
}

/// The file's tangents in the scene: directions on the surface go there as edges do.
Positions scene_tangents(const RenderTangents& tangents, const SourceMesh& first) {
  return tangents.in_file.leftCols<3>().cast<double>() * linear_part(first).transpose();
}

/// What a triangle makes of a direction in its plane.
Eigen::RowVector3d carried(const Eigen::Matrix<double, 2, 3>& rest_edges,
                           const Eigen::Matrix<double, 2, 3>& edges,
                           const Eigen::RowVector3d& direction) {
  const Eigen::Matrix2d gram = rest_edges * rest_edges.transpose();
  if (!(gram.determinant() > 0)) return Eigen::RowVector3d::Zero();
  const Eigen::Vector2d shares = gram.inverse() * (rest_edges * direction.transpose());
  return shares.transpose() * edges;
}

Eigen::Matrix<double, 2, 3> edges_of(const Positions& positions, const Eigen::Vector3i& corners) {
  Eigen::Matrix<double, 2, 3> edges;
  edges << positions.row(corners(1)) - positions.row(corners(0)),
      positions.row(corners(2)) - positions.row(corners(0));
  return edges;
}

/// Sums of what the triangles at each vertex make of its tangent, weighted by their area at rest,
/// brought into the plane of its normal; rows of 0 where nothing is left.
///
/// @param normals  of the groups
Positions surface_tangents(const Positions& directions, const SourceMesh& first,
                           const SmoothingGroups& groups, const MorphableMesh& mesh,
                           const Positions& positions, const Normals& normals) {
  Positions sums = Positions::Zero(directions.rows(), 3);
  for (std::size_t f = 0; f < mesh.triangle_of_file.size(); ++f) {
    if (mesh.triangle_of_file[f] < 0) continue;
    const Eigen::Vector3i renders = first.triangles.row(static_cast<Eigen::Index>(f)).transpose();
    Eigen::Vector3i corners;
    for (int k = 0; k < 3; ++k) {
      corners(k) = mesh.vertex_of_render[static_cast<std::size_t>(renders(k))];
    }
    const auto rest = edges_of(mesh.geometries[0], corners);
    const double area = Eigen::Vector3d(rest.row(0)).cross(Eigen::Vector3d(rest.row(1))).norm();
    const auto edges = edges_of(positions, corners);
    for (const int r : renders) sums.row(r) += area * carried(rest, edges, directions.row(r));
  }
  for (Eigen::Index r = 0; r < sums.rows(); ++r) {
    const int group = groups.of_render[static_cast<std::size_t>(r)];
    if (group < 0) continue;
    const Eigen::RowVector3d normal = normals.row(group);
    sums.row(r) -= sums.row(r).dot(normal) * normal;
    sums.row(r).normalize();
  }
  return sums;
}

/// The turn between two orthonormal pairs.
Eigen::Matrix3d turn_between(const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent,
                             const Eigen::Vector3d& new_normal,
                             const Eigen::Vector3d& new_tangent) {
  Eigen::Matrix3d from, to;
  from << normal, tangent, normal.cross(tangent);
  to << new_normal, new_tangent, new_normal.cross(new_tangent);
  return to * from.transpose();
}

}  // namespace

RenderTangents find_tangents(const SourceMesh& first, const MorphableMesh& mesh,
                             const SmoothingGroups& groups) {
  if (groups.count == 0) return {};
  const VertexAttribute read = read_vertex_attribute(first.file, first.geometry.mesh, "TANGENT");
  RenderTangents tangents;
  tangents.is_given = normal_mapped_primitives(first.file, first.geometry.mesh);
  bool is_any = false;
  for (std::size_t p = 0; p < tangents.is_given.size(); ++p) {
    tangents.is_given[p] = tangents.is_given[p] && read.values.cols() == 4 && read.is_given[p];
    is_any = is_any || tangents.is_given[p];
  }
  if (!is_any) return {};
  tangents.in_file = read.values;
  tangents.surface = surface_tangents(scene_tangents(tangents, first), first, groups, mesh,
                                      mesh.geometries[0], groups.source_normals);
  return tangents;
}

Positions deformed_tangents(const RenderTangents& tangents, const SourceMesh& first,
                            const SmoothingGroups& groups, const MorphableMesh& mesh,
                            const Positions& positions) {
  const Positions old = scene_tangents(tangents, first);
  const Normals normals = deformed_normals(groups, mesh, positions);
  const Positions surface = surface_tangents(old, first, groups, mesh, positions, normals);
  const Eigen::Matrix3d to_mesh = linear_part(first).inverse();
  Positions turned = tangents.in_file.leftCols<3>().cast<double>();
  for (Eigen::Index r = 0; r < turned.rows(); ++r) {
    const int group = groups.of_render[static_cast<std::size_t>(r)];
    if (group < 0 || surface.row(r).isZero(0) || tangents.surface.row(r).isZero(0)) continue;
    const bool is_still = surface.row(r) == tangents.surface.row(r) &&
                          normals.row(group) == groups.source_normals.row(group);
    if (is_still) continue;  // its own numbers, bit for bit
    const Eigen::Matrix3d turn =
        turn_between(groups.source_normals.row(group), tangents.surface.row(r), normals.row(group),
                     surface.row(r));
    turned.row(r) = (to_mesh * (turn * old.row(r).transpose())).normalized().transpose();
  }
  return turned;
}

}  // namespace morphbake
