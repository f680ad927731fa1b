#include "morphbake/bake/surface_colours.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace morphbake {
namespace {

/// Index of a triangle's first corner, as one into lists of corners.
std::size_t first_corner(int triangle) { return 3 * static_cast<std::size_t>(triangle); }

/// Columns are a vertex attribute of the triangle's corners.
template <typename Rows>
auto at_corners(const Rows& rows, const int* corners) {
  Eigen::Matrix<float, Rows::ColsAtCompileTime, 3> columns;
  for (int k = 0; k < 3; ++k) columns.col(k) = rows.row(corners[k]).transpose();
  return columns;
}

/// log2 of the texels that a width on the surface covers along a side; 0 for less than one.
float texture_level(const Image& image, const Eigen::Matrix<float, 2, 3>& uv, double area,
                    double width) {
  const Eigen::Vector2d a = (uv.col(1) - uv.col(0)).cast<double>();
  const Eigen::Vector2d b = (uv.col(2) - uv.col(0)).cast<double>();
  const double texels = std::abs(a.x() * b.y() - a.y() * b.x()) / 2 * image.width * image.height;
  const double side = area > 0 ? width * std::sqrt(texels / area) : 0;
  return side > 1 ? static_cast<float>(std::log2(side)) : 0.0F;
}

double area_of(const Mesh& mesh, int triangle) {
  const auto corner = [&](int k) {
    return Eigen::Vector3d(mesh.positions.row(mesh.triangles(triangle, k)).transpose());
  };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 2;
}

}  // namespace

bool SurfaceColours::any() const {
  const std::vector<AnimatedPrimitive>& all = mesh.primitives;
  return std::any_of(all.begin(), all.end(), [&](const AnimatedPrimitive& each) {
    return each.colours.rows() > 0 || (each.image >= 0 && each.texture_coordinates.rows() > 0) ||
           each.base_colour != all.front().base_colour;
  });
}

SurfaceColours surface_colours(const SourceMesh& source, const SourceSurface& surface,
                               const Observer& observer) {
  SurfaceColours colours;
  colours.mesh = read_animated_mesh(source.file, {.node = source.geometry.node});
  colours.appearance = make_appearance(colours.mesh, observer);
  colours.material = first_material(source.file, source.geometry.mesh).value_or(PlainMaterial{});
  std::vector<int> firsts;  // render vertex that each primitive begins with
  int count = 0;
  for (const AnimatedPrimitive& primitive : colours.mesh.primitives) {
    firsts.push_back(count);
    count += static_cast<int>(primitive.positions.rows());
  }
  for (const int render : surface.render_of_corner) {
    const auto after = std::upper_bound(firsts.begin(), firsts.end(), render);
    const auto primitive = static_cast<int>(after - firsts.begin()) - 1;
    if (colours.corners.size() % 3 == 0) colours.primitive.push_back(primitive);
    colours.corners.push_back(render - firsts[static_cast<std::size_t>(primitive)]);
  }
  for (int f = 0; f < surface.mesh.triangles.rows(); ++f) {
    colours.area.push_back(area_of(surface.mesh, f));
  }
  return colours;
}

Eigen::Array3f colour_at(const SurfaceColours& colours, const SurfacePoint& at, double width) {
  const auto triangle = static_cast<std::size_t>(at.triangle);
  const AnimatedPrimitive& primitive =
      colours.mesh.primitives[static_cast<std::size_t>(colours.primitive[triangle])];
  const int* corners = &colours.corners[first_corner(at.triangle)];
  const Eigen::Vector3f weights = at.barycentric.cast<float>();
  Eigen::Array3f colour = primitive.base_colour.array();
  if (primitive.colours.rows() > 0) {
    colour *= (at_corners(primitive.colours, corners) * weights).array();
  }
  const MipLevels* texture = texture_of(primitive, colours.appearance);
  if (texture != nullptr) {
    const auto uv = at_corners(primitive.texture_coordinates, corners);
    const float level = texture_level(texture->front(), uv, colours.area[triangle], width);
    const Eigen::Vector2f place = uv * weights;
    if (place.allFinite() && std::isfinite(level)) colour *= texture_at(*texture, place, level);
  }
  return colour.max(0.0F).min(1.0F);
}

}  // namespace morphbake
