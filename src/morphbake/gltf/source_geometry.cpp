#include "morphbake/gltf/source_geometry.h"

#include <fmt/core.h>

#include <Eigen/LU>

#include "morphbake/gltf/moment.h"
#include "morphbake/gltf/names.h"
#include "morphbake/gltf/nodes.h"
#include "morphbake/gltf/primitive_geometry.h"
#include "morphbake/gltf/size_limits.h"
#include "morphbake/gltf/skin.h"

namespace morphbake {
namespace {

/// Morph targets need the same attributes in every primitive, else viewers mix them up.
void check_normals(const GltfDocument& document, const SourceGeometry& source) {
  const bool first_has = source.primitives.front().normals.rows() > 0;
  for (std::size_t p = 1; p < source.primitives.size(); ++p) {
    if ((source.primitives[p].normals.rows() > 0) == first_has) continue;
    fail_at(document, primitive_pointer(source.mesh, p) + "/attributes", "gltf.mixed-normals",
            "some primitives of the mesh have NORMAL and others have not",
            "export the whole mesh with normals, or all of it without");
  }
}

const tinygltf::Node& node_of(const GltfDocument& document, const SourceGeometry& source) {
  return document.model.nodes[static_cast<std::size_t>(source.node)];
}

const tinygltf::Mesh& mesh_of(const GltfDocument& document, const SourceGeometry& source) {
  return document.model.meshes[static_cast<std::size_t>(source.mesh)];
}

/// Weights of the mesh's own targets in the shape that is chosen.
Eigen::VectorXd chosen_weights(const GltfDocument& document, const SourceGeometry& source,
                               const MeshChoice& choice) {
  const tinygltf::Mesh& mesh = mesh_of(document, source);
  const std::size_t count = target_count(document, source.mesh);
  Eigen::VectorXd weights = rest_weights(node_of(document, source), mesh, count);
  if (is_chosen(choice.target)) {
    const int target = index_of_choice(document, choice.target, target_names(mesh, count), "target",
                                       fmt::format("/meshes/{}/extras/targetNames", source.mesh));
    weights = Eigen::VectorXd::Unit(static_cast<Eigen::Index>(count), target);
  }
  if (choice.moment) weights = weights_at(document, source.node, *choice.moment, weights);
  return weights;
}

/// Adds weighted targets to a primitive's base shape. All are read, since all are kept.
void add_targets(const GltfDocument& document, const tinygltf::Primitive& primitive,
                 const Eigen::VectorXd& weights, const std::string& pointer,
                 PrimitiveGeometry& geometry) {
  for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
    const TargetGeometry target =
        read_target(document, primitive, t, geometry.positions.rows(), pointer);
    const auto weight = static_cast<float>(weights(static_cast<Eigen::Index>(t)));
    if (weight == 0) continue;
    if (target.positions.rows() > 0) geometry.positions += weight * target.positions;
    if (target.normals.rows() > 0 && geometry.normals.rows() > 0) {
      geometry.normals += weight * target.normals;
    }
  }
}

/// Brings the mesh into a space that `to_scene` takes to the scene.
void change_space(const Eigen::Matrix4d& to_scene, SourceGeometry& source) {
  const Eigen::Matrix4d change = to_scene.inverse() * source.to_scene;
  const Eigen::Matrix3d linear = change.topLeftCorner<3, 3>();
  const Eigen::RowVector3d translation = change.topRightCorner<3, 1>().transpose();
  const Eigen::Matrix3d of_normals = linear.inverse();
  for (PrimitiveGeometry& primitive : source.primitives) {
    const Positions moved =
        (primitive.positions.cast<double>() * linear.transpose()).rowwise() + translation;
    primitive.positions = moved.cast<float>();
    const Positions turned = primitive.normals.cast<double>() * of_normals;
    primitive.normals = turned.rowwise().normalized().cast<float>();
  }
  source.to_scene = to_scene;
}

/// Poses the mesh by its skeleton at a moment. Posed, it no longer hangs on the skeleton: it is in
/// the space of its node, unless that is flat.
void pose_mesh(const GltfDocument& document, const Moment& moment, SourceGeometry& source) {
  const NodeOrder order = order_nodes(document, transforms_at(document, moment));
  std::vector<Eigen::Matrix4d> joints =
      joint_transforms(document, node_of(document, source).skin, order.to_scene);
  const Eigen::Matrix4d to_mesh = source.to_scene.inverse();
  for (Eigen::Matrix4d& joint : joints) joint = to_mesh * joint;
  const tinygltf::Mesh& mesh = mesh_of(document, source);
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const SkinBinding binding = read_binding(document, mesh.primitives[p], joints.size(),
                                             primitive_pointer(source.mesh, p));
    pose(binding, joints, source.primitives[p].positions, source.primitives[p].normals);
  }
  source.is_posed = true;
  const NodeOrder at_rest = order_nodes(document, rest_transforms(document));
  const Eigen::Matrix4d& of_node = at_rest.to_scene[static_cast<std::size_t>(source.node)];
  if (is_invertible(of_node)) change_space(of_node, source);
}

void check_finite(const GltfDocument& document, const SourceGeometry& source) {
  for (std::size_t p = 0; p < source.primitives.size(); ++p) {
    if (source.primitives[p].positions.allFinite() && source.primitives[p].normals.allFinite()) {
      continue;
    }
    fail_at(document, primitive_pointer(source.mesh, p), "gltf.not-finite",
            "with its targets' weights and pose the mesh is not finite");
  }
}

}  // namespace

std::string primitive_pointer(int mesh, std::size_t primitive) {
  return fmt::format("/meshes/{}/primitives/{}", mesh, primitive);
}

SourceGeometry read_source_geometry(const GltfFile& file, const MeshChoice& choice) {
  const GltfDocument& document = *file;
  const MeshNode at = choose_mesh_node(document, choice, Ambiguity::Refuse);
  SourceGeometry source;
  source.node = at.node;
  source.mesh = at.mesh;
  source.to_scene = at.to_scene;
  source.is_at_rest = !is_chosen(choice.target) && !choice.moment;
  check_mesh_size(document, at.mesh);
  const Eigen::VectorXd weights = chosen_weights(document, source, choice);
  const tinygltf::Mesh& mesh = mesh_of(document, source);
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const std::string pointer = primitive_pointer(at.mesh, p);
    source.primitives.push_back(read_primitive_geometry(document, mesh.primitives[p], pointer));
    add_targets(document, mesh.primitives[p], weights, pointer, source.primitives.back());
  }
  if (source.primitives.empty()) {
    fail_at(document, fmt::format("/meshes/{}", at.mesh), "gltf.no-mesh",
            "the mesh has no primitive");
  }
  check_normals(document, source);
  const bool is_skinned = node_of(document, source).skin >= 0;
  if (choice.moment && is_skinned) pose_mesh(document, *choice.moment, source);
  // What stands in the file was checked when it was read.
  if (source.is_posed || (weights.array() != 0).any()) check_finite(document, source);
  return source;
}

}  // namespace morphbake
