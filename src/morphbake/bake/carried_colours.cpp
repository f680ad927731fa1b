#include "morphbake/bake/carried_colours.h"

#include <algorithm>
#include <array>

#include "morphbake/preview/appearance.h"

namespace morphbake {
namespace {

/// A render vertex of the file as a vertex of one of its primitives.
struct PrimitiveVertex {
  std::size_t primitive = 0;
  Eigen::Index vertex = 0;
};

std::vector<PrimitiveVertex> primitive_vertices(const AnimatedMesh& mesh) {
  std::vector<PrimitiveVertex> vertices;
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const Eigen::Index count = mesh.primitives[p].positions.rows();
    for (Eigen::Index v = 0; v < count; ++v) vertices.push_back({p, v});
  }
  return vertices;
}

bool has_one_factor(const AnimatedMesh& mesh) {
  return std::all_of(mesh.primitives.begin(), mesh.primitives.end(), [&](const auto& primitive) {
    return primitive.base_colour == mesh.primitives.front().base_colour;
  });
}

bool has_detail(const AnimatedMesh& mesh) {
  return std::any_of(mesh.primitives.begin(), mesh.primitives.end(), [](const auto& primitive) {
    return primitive.colours.rows() > 0 || primitive.image >= 0;
  });
}

/// COLOR_0 times texture at a point; corners are in one primitive.
Eigen::Array3f colour_at(const AnimatedMesh& mesh, const Appearance& appearance,
                         const std::array<PrimitiveVertex, 3>& corners,
                         const Eigen::Vector3d& barycentric) {
  const AnimatedPrimitive& primitive = mesh.primitives[corners[0].primitive];
  Eigen::Array3f colour = Eigen::Array3f::Ones();
  const Eigen::Vector3f weights = barycentric.cast<float>();
  if (primitive.colours.rows() > 0) {
    colour.setZero();
    for (int k = 0; k < 3; ++k) {
      const auto row = primitive.colours.row(corners[static_cast<std::size_t>(k)].vertex);
      colour += weights(k) * row.transpose().array();
    }
  }
  const MipLevels* texture = texture_of(primitive, appearance);
  if (texture == nullptr) return colour;
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto vertex = corners[static_cast<std::size_t>(k)].vertex;
    uv += weights(k) * primitive.texture_coordinates.row(vertex).transpose();
  }
  if (!uv.allFinite()) return colour;
  return colour * texture_at(*texture, uv, 0);
}

}  // namespace

CarriedColours carry_colours(const SourceMesh& source, const SourceSurface& surface,
                             const std::vector<SurfacePoint>& points, const Observer& observer) {
  CarriedColours carried;
  carried.material = first_material(source.file, source.geometry.mesh);
  const AnimatedMesh mesh = read_animated_mesh(source.file, {.node = source.geometry.node});
  const bool one_factor = has_one_factor(mesh);
  if (one_factor && !has_detail(mesh)) return carried;
  if (!one_factor) {
    if (!carried.material) carried.material.emplace();
    carried.material->base_colour.setOnes();
  }
  const Appearance appearance = make_appearance(mesh, observer);
  const std::vector<PrimitiveVertex> vertices = primitive_vertices(mesh);
  carried.colours.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<PrimitiveVertex, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = 3 * static_cast<std::size_t>(points[i].triangle) + k;
      corners[k] = vertices[static_cast<std::size_t>(surface.render_of_corner[corner])];
    }
    Eigen::Array3f colour = colour_at(mesh, appearance, corners, points[i].barycentric);
    if (!one_factor) colour *= mesh.primitives[corners[0].primitive].base_colour.array();
    carried.colours.row(static_cast<Eigen::Index>(i)) =
        colour.max(0.0F).min(1.0F).matrix().transpose();
  }
  return carried;
}

}  // namespace morphbake
