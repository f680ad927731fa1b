#include "morphbake/bake/shape_colours.h"

#include <algorithm>

#include "morphbake/gltf/animated_mesh.h"

namespace morphbake {
namespace {

/// COLOR_0 of a file with one primitive, brought to the vertices of K.
Positions colours_of(const SourceMesh& source, const MorphableMesh& mesh) {
  const AnimatedMesh file = read_animated_mesh(source.file, {.node = source.geometry.node});
  const Float3s& rows = file.primitives.front().colours;
  Positions colours = Positions::Ones(mesh.connectivity.vertex_count, 3);
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    const int vertex = mesh.vertex_of_render[static_cast<std::size_t>(r)];
    if (vertex >= 0) colours.row(vertex) = rows.row(r).cast<double>();
  }
  return colours;
}

}  // namespace

ShapeColours shape_colours(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                           const MorphableMesh& mesh) {
  constexpr double kSeen = 1.0 / 512;  // half a step of 8-bit colours
  if (recipe.connectivity.mode == ConnectivityMode::Shared) return {};
  ShapeColours colours;
  for (const SourceMesh& source : sources) colours.push_back(colours_of(source, mesh));
  const bool is_one = std::all_of(colours.begin(), colours.end(), [&](const Positions& other) {
    return (other - colours.front()).cwiseAbs().maxCoeff() <= kSeen;
  });
  if (is_one) return {};
  for (const DerivedSource& derived : recipe.derived) {
    colours.push_back(colours[static_cast<std::size_t>(derived.root)]);
  }
  return colours;
}

Positions mixed_colours(const ShapeColours& colours, const TransitionState& T) {
  const Eigen::Index count = colours.front().rows();
  Positions mixed = Positions::Zero(count, 3);
  for (std::size_t s = 0; s < colours.size(); ++s) {
    const auto shares = T.row(static_cast<Eigen::Index>(s));
    Eigen::VectorXd share = shares.head(count);
    if (T.cols() > count)
      share =
          (share + shares.segment(count, count).transpose() + shares.tail(count).transpose()) / 3;
    if (!share.isZero(0)) mixed += share.asDiagonal() * colours[s];
  }
  return mixed.cwiseMax(0).cwiseMin(1);
}

}  // namespace morphbake
