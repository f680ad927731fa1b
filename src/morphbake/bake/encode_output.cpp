#include "morphbake/bake/encode_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/gltf/compress_meshopt.h"
#include "morphbake/gltf/order_vertices.h"
#include "morphbake/gltf/quantize_mesh.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

/// Of the new targets, over all keys.
std::vector<float> mean_weights(const MeshMorph& morph) {
  std::vector<float> means(morph.target_names.size(), 0.0F);
  float keys = 0;
  for (const MorphClip& clip : morph.clips) {
    keys += static_cast<float>(clip.key_weights.rows());
    const Eigen::VectorXf sums = clip.key_weights.colwise().sum();
    for (std::size_t k = 0; k < means.size(); ++k) means[k] += sums(static_cast<Eigen::Index>(k));
  }
  for (float& mean : means) mean /= std::max(1.0F, keys);
  return means;
}

/// Where bytes count, integers are as coarse as a fifth of the error that is allowed anyway.
QuantizedSteps steps_of(const SourceMesh& first, const Output& output, double diagonal,
                        std::vector<float> means) {
  if (output.encoding == Encoding::Quantized) return {0, 16, std::move(means)};
  const Eigen::Matrix3d to_scene = first.geometry.to_scene.topLeftCorner<3, 3>();
  const double largest_scale = to_scene.colwise().norm().maxCoeff();
  return {largest_scale > 0 ? 0.2 * output.max_error * diagonal / largest_scale : 0, 8,
          std::move(means)};
}

}  // namespace

EncodedOutput encode_output(const SourceMesh& first, const Output& output, double diagonal,
                            MeshMorph morph) {
  const bool reads_sparse = !output.profile || output.profile->sparse == SparseSupport::Any;
  morph.may_be_sparse = output.encoding != Encoding::Float && reads_sparse;
  EncodedOutput encoded{
      write_morph_glb(first.file, morph, fmt::format("morphbake {}", version())), morph.node, {}};
  const std::vector<float> means = mean_weights(morph);
  morph = {};
  const auto take_file = [&] { return open_gltf_bytes(std::move(encoded.glb), output.file); };
  const bool is_small = output.encoding == Encoding::Meshopt;
  if (is_small) {
    OrderedMorph ordered = order_vertices(take_file(), encoded.node);
    encoded.glb = std::move(ordered.glb);
    encoded.old_vertex = std::move(ordered.old_vertex);
  }
  if (is_small || output.encoding == Encoding::Quantized) {
    EncodedMorph quantized =
        quantize_mesh(take_file(), encoded.node, steps_of(first, output, diagonal, means));
    encoded.glb = std::move(quantized.glb);
    encoded.node = quantized.node;
  }
  if (is_small) encoded.glb = compress_meshopt(take_file());
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
