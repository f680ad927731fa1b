#include "morphbake/bake/shape_colours.h"

#include <algorithm>
#include <optional>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/vertex_attributes.h"

namespace morphbake {
namespace {

/// COLOR_0 of a file, and what it is multiplied by.
struct FileColours {
  Positions rows;                          ///< #R by 3
  std::vector<Eigen::Vector3f> factors;    ///< one a primitive
  std::vector<TriangleIndices> triangles;  ///< likewise
};

std::optional<FileColours> colours_of(const SourceMesh& source) {
  const VertexAttribute colours =
      read_vertex_attribute(source.file, source.geometry.mesh, "COLOR_0");
  const bool are_all_given = std::all_of(colours.is_given.begin(), colours.is_given.end(),
                                         [](bool is_given) { return is_given; });
  if (colours.values.cols() != 3 || !are_all_given) return {};
  FileColours file{colours.values.cast<double>(), {}, {}};
  const AnimatedMesh mesh = read_animated_mesh(source.file, {.node = source.geometry.node});
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    file.factors.push_back(primitive.base_colour);
    file.triangles.push_back(primitive.triangles);
  }
  return file;
}

bool looks_alike(const Positions& a, const Positions& b) {
  constexpr double kSeen = 1.0 / 512;  // half a step of 8-bit colours
  return (a - b).cwiseAbs().maxCoeff() <= kSeen;
}

}  // namespace

ShapeColours shape_colours(const Recipe& recipe, const std::vector<SourceMesh>& sources) {
  ShapeColours colours;
  std::optional<FileColours> first;
  for (const SourceMesh& source : sources) {
    std::optional<FileColours> file = colours_of(source);
    if (!file) return {};
    if (!first) first = file;
    if (file->factors != first->factors || file->triangles != first->triangles) return {};
    colours.push_back(std::move(file->rows));
  }
  const bool is_one = std::all_of(colours.begin(), colours.end(), [&](const Positions& other) {
    return looks_alike(other, colours.front());
  });
  if (is_one) return {};
  for (const DerivedSource& derived : recipe.derived) {
    colours.push_back(colours[static_cast<std::size_t>(derived.root)]);
  }
  return colours;
}

Positions mixed_colours(const ShapeColours& colours, const MorphableMesh& mesh,
                        const TransitionState& T) {
  const Eigen::Index vertices = mesh.connectivity.vertex_count;
  Positions mixed = Positions::Zero(colours.front().rows(), 3);
  for (Eigen::Index r = 0; r < mixed.rows(); ++r) {
    const int v = mesh.vertex_of_render[static_cast<std::size_t>(r)];
    if (v < 0) {
      mixed.row(r) = colours.front().row(r);
      continue;
    }
    for (std::size_t s = 0; s < colours.size(); ++s) {
      const auto shape = static_cast<Eigen::Index>(s);
      double share = T(shape, v);
      if (T.cols() > vertices) {
        share = (share + T(shape, v + vertices) + T(shape, v + 2 * vertices)) / 3;
      }
      if (share != 0) mixed.row(r) += share * colours[s].row(r);
    }
  }
  return mixed.cwiseMax(0).cwiseMin(1);
}

}  // namespace morphbake
