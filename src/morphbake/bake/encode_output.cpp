#include "morphbake/bake/encode_output.h"

#include <fmt/core.h>

#include <utility>

#include "morphbake/gltf/compress_meshopt.h"
#include "morphbake/gltf/order_vertices.h"
#include "morphbake/gltf/quantise_mesh.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

/// Where bytes count, integers are as coarse as a tenth of the error that is allowed anyway.
QuantisedSteps steps_of(const SourceMesh& first, const Output& output, double diagonal) {
  if (output.compression == Compression::None) return {};
  const Eigen::Matrix3d to_scene = first.geometry.to_scene.topLeftCorner<3, 3>();
  const double largest_scale = to_scene.colwise().norm().maxCoeff();
  return {largest_scale > 0 ? 0.1 * output.max_error * diagonal / largest_scale : 0, 8};
}

}  // namespace

EncodedOutput encode_output(const SourceMesh& first, const Output& output, double diagonal,
                            MeshMorph morph) {
  EncodedOutput encoded{
      write_morph_glb(first.file, morph, fmt::format("morphbake {}", version())), morph.node, {}};
  morph = {};
  const auto take_file = [&] { return open_gltf_bytes(std::move(encoded.glb), output.file); };
  if (output.compression == Compression::Meshopt) {
    OrderedMorph ordered = order_vertices(take_file(), encoded.node);
    encoded.glb = std::move(ordered.glb);
    encoded.old_vertex = std::move(ordered.old_vertex);
  }
  if (output.encoding == Encoding::Quantised) {
    EncodedMorph quantised =
        quantise_mesh(take_file(), encoded.node, steps_of(first, output, diagonal));
    encoded.glb = std::move(quantised.glb);
    encoded.node = quantised.node;
  }
  if (output.compression == Compression::Meshopt) encoded.glb = compress_meshopt(take_file());
  return encoded;
}

void restore_order(const std::vector<std::vector<int>>& old_vertex, AnimatedMesh& mesh) {
  for (std::size_t p = 0; p < old_vertex.size(); ++p) {
    if (old_vertex[p].empty()) continue;
    const auto restore = [&](Float3s& rows) {
      if (rows.rows() == 0) return;
      const Float3s moved = rows;
      rows(old_vertex[p], Eigen::all) = moved;
    };
    AnimatedPrimitive& primitive = mesh.primitives[p];
    restore(primitive.positions);
    restore(primitive.normals);
    for (Float3s& rows : primitive.target_positions) restore(rows);
    for (Float3s& rows : primitive.target_normals) restore(rows);
  }
}

}  // namespace morphbake
