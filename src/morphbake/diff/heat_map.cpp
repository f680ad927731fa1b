#include "morphbake/diff/heat_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "morphbake/gltf/morphed_rows.h"
#include "morphbake/gltf/write_mesh.h"
#include "morphbake/mesh/normals.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

constexpr double kDecades = 3;  // from yellow to red
constexpr double kNotCompared = std::numeric_limits<double>::quiet_NaN();

double share_of(double difference, double allowed) {
  if (difference == 0) return 0;
  return allowed > 0 ? difference / allowed : std::numeric_limits<double>::infinity();
}

/// One a vertex that was compared.
Eigen::VectorXd shares_of(const MeshDifference& mesh) {
  Eigen::VectorXd shares(mesh.vertices.distance.size());
  for (Eigen::Index v = 0; v < shares.size(); ++v) {
    shares(v) = share_of(mesh.vertices.distance(v), mesh.allowed.distance);
    if (!mesh.allowed.normal_angle) continue;
    shares(v) =
        std::max(shares(v), share_of(mesh.vertices.normal_angle(v), *mesh.allowed.normal_angle));
  }
  return shares;
}

/// Appends the rows of `more`.
template <typename Rows>
void append(const Rows& more, Rows& rows) {
  const Eigen::Index first = rows.rows();
  rows.conservativeResize(first + more.rows(), Eigen::NoChange);
  rows.bottomRows(more.rows()) = more;
}

/// Base shape and targets at rest, in the scene.
void append_at_rest(const AnimatedMesh& mesh, const AnimatedPrimitive& primitive, PlainMesh& all) {
  const auto posed = [&](const Float3s& base, const std::vector<Float3s>& targets) -> Float3s {
    return morphed_rows(base, targets, mesh.rest_weights).cast<float>();
  };
  const Eigen::Affine3d to_scene(mesh.to_scene);
  const Eigen::Matrix3f linear = to_scene.linear().cast<float>();
  const Eigen::RowVector3f offset = to_scene.translation().transpose().cast<float>();
  TriangleIndices triangles = primitive.triangles.array() + static_cast<int>(all.positions.rows());
  if (linear.determinant() < 0) triangles.col(1).swap(triangles.col(2));
  const Float3s positions = posed(primitive.positions, primitive.target_positions);
  append(Float3s((positions * linear.transpose()).rowwise() + offset), all.positions);
  append(triangles, all.triangles);
  append(primitive.colours, all.colours);
}

/// Of unit length everywhere, as glTF wants it, also where no triangle with an area is.
Float3s unit_normals(const PlainMesh& mesh) {
  Normals normals = smooth_normals(mesh.positions.cast<double>(), mesh.triangles);
  for (auto normal : normals.rowwise()) {
    if (normal.isZero()) normal = Eigen::RowVector3d::UnitZ();
  }
  return normals.cast<float>();
}

}  // namespace

Eigen::Vector3f heat_colour(double share) {
  const Eigen::Vector3f grey(0.6F, 0.6F, 0.6F), blue(0.05F, 0.2F, 0.8F), yellow(1, 0.75F, 0),
      red(0.8F, 0, 0), violet(0.3F, 0, 0.5F);
  if (std::isnan(share)) return violet;
  if (share <= 1) return grey + static_cast<float>(share) * (blue - grey);
  const double along = std::min(std::log10(share) / kDecades, 1.0);
  return yellow + static_cast<float>(along) * (red - yellow);
}

AnimatedMesh heat_mesh(const FileDifference& difference, const MeshDifference& mesh) {
  AnimatedMesh heat = read_animated_mesh(difference.file_a, {.node = mesh.node_a});
  const Eigen::VectorXd shares = shares_of(mesh);
  Eigen::Index first = 0;
  for (std::size_t p = 0; p < heat.primitives.size(); ++p) {
    AnimatedPrimitive& primitive = heat.primitives[p];
    const bool is_compared = std::ranges::count(mesh.primitives, p) > 0;
    primitive.image = -1;
    primitive.base_colour.setOnes();
    primitive.colours.resize(primitive.positions.rows(), 3);
    for (Eigen::Index v = 0; v < primitive.positions.rows(); ++v) {
      const double share = is_compared ? shares(first + v) : kNotCompared;
      primitive.colours.row(v) = heat_colour(share).transpose();
    }
    if (is_compared) first += primitive.positions.rows();
  }
  heat.images.clear();
  heat.image_names.clear();
  return heat;
}

const MeshDifference& worst_mesh(const FileDifference& difference) {
  const auto worst_share = [](const MeshDifference& mesh) {
    const Eigen::VectorXd shares = shares_of(mesh);
    return shares.size() > 0 ? shares.maxCoeff() : 0.0;
  };
  return *std::ranges::max_element(difference.meshes, {}, worst_share);
}

std::string heat_map_glb(const FileDifference& difference) {
  PlainMesh all;
  all.name = "differences";
  all.material = PlainMaterial{.name = "differences", .metallic = 0, .double_sided = true};
  for (const MeshDifference& mesh : difference.meshes) {
    const AnimatedMesh heat = heat_mesh(difference, mesh);
    for (const AnimatedPrimitive& primitive : heat.primitives) append_at_rest(heat, primitive, all);
  }
  all.normals = unit_normals(all);
  return write_mesh_glb(all, std::string("morphbake ") + version());
}

}  // namespace morphbake
