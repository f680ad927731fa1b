#include "morphbake/preview/appearance.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "morphbake/images/srgb.h"

namespace morphbake {
namespace {

/// Linear RGB of a surface without any colour: warm clay, dark enough to show its lights.
const Eigen::Array3f kClay{0.56f, 0.46f, 0.385f};

bool has_texture(const AnimatedPrimitive& primitive) {
  return primitive.image >= 0 && primitive.texture_coordinates.rows() > 0;
}

bool has_colour(const AnimatedPrimitive& primitive) {
  return primitive.colours.rows() > 0 || has_texture(primitive) ||
         primitive.base_colour != Eigen::Vector3f::Ones();
}

MipLevels make_mip_levels(Image image) {
  MipLevels levels{std::move(image)};
  while (std::max(levels.back().width, levels.back().height) > 1) {
    const Image& last = levels.back();
    levels.push_back(scale_down(last, std::max(1, last.width / 2), std::max(1, last.height / 2)));
  }
  return levels;
}

int wrapped(int i, int size) {
  const int rest = i % size;
  return rest < 0 ? rest + size : rest;
}

Eigen::Array3f texel(const Image& image, int x, int y) {
  const std::size_t row = static_cast<std::size_t>(wrapped(y, image.height));
  const std::size_t column = static_cast<std::size_t>(wrapped(x, image.width));
  const std::uint8_t* rgb = &image.rgb[(row * static_cast<std::size_t>(image.width) + column) * 3];
  return {srgb_to_linear(rgb[0]), srgb_to_linear(rgb[1]), srgb_to_linear(rgb[2])};
}

Eigen::Array3f bilinear(const Image& image, const Eigen::Vector2f& uv) {
  // Only the fraction counts: far coordinates would not fit an int.
  const float x = (uv.x() - std::floor(uv.x())) * static_cast<float>(image.width) - 0.5f;
  const float y = (uv.y() - std::floor(uv.y())) * static_cast<float>(image.height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const float a = x - left, b = y - top;
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  return (1 - b) * ((1 - a) * texel(image, i, j) + a * texel(image, i + 1, j)) +
         b * ((1 - a) * texel(image, i, j + 1) + a * texel(image, i + 1, j + 1));
}

/// A row of a per-vertex attribute between a triangle's corners.
template <class Rows>
auto interpolated(const Rows& rows, const TriangleIndices& triangles, const RayHit& hit) {
  const auto corners = triangles.row(hit.triangle);
  return (hit.barycentric[0] * rows.row(corners[0]) + hit.barycentric[1] * rows.row(corners[1]) +
          hit.barycentric[2] * rows.row(corners[2]))
      .transpose()
      .eval();
}

/// Texels of the full picture that a footprint covers, as a level: log2 of their side.
float texture_level(const AnimatedPrimitive& primitive, const Image& image, const RayHit& hit,
                    float footprint, float triangle_area) {
  const auto corners = primitive.triangles.row(hit.triangle);
  const auto& uv = primitive.texture_coordinates;
  const Eigen::RowVector2f a = uv.row(corners[1]) - uv.row(corners[0]);
  const Eigen::RowVector2f b = uv.row(corners[2]) - uv.row(corners[0]);
  const float uv_area = std::abs(a.x() * b.y() - a.y() * b.x()) / 2;
  const float texels = uv_area * static_cast<float>(image.width) * static_cast<float>(image.height);
  const float side = footprint * std::sqrt(texels / std::max(triangle_area, 1e-20f));
  return std::log2(std::max(side, 1e-6f));
}

/// The picture, or an empty one after a warning.
MipLevels decoded_texture(const AnimatedMesh& mesh, std::size_t image, const Observer& observer) {
  const std::string name = image < mesh.image_names.size() ? mesh.image_names[image] : "";
  try {
    return make_mip_levels(decode_image(mesh.images[image], name));
  } catch (const BakeError& error) {
    for (Problem problem : error.problems()) {
      problem.severity = Severity::Warning;
      problem.hint = "pictures show the surface without it; " + problem.hint;
      report(observer, problem);
    }
    return {};
  }
}

}  // namespace

Appearance make_appearance(const AnimatedMesh& mesh, const Observer& observer) {
  Appearance appearance;
  appearance.textures.resize(mesh.images.size());
  std::vector<bool> is_tried(mesh.images.size(), false);
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    appearance.factors.push_back(has_colour(primitive) ? primitive.base_colour.array() : kClay);
    if (!has_texture(primitive)) continue;
    const std::size_t image = static_cast<std::size_t>(primitive.image);
    if (is_tried[image]) continue;
    is_tried[image] = true;
    appearance.textures[image] = decoded_texture(mesh, image, observer);
  }
  return appearance;
}

const MipLevels* texture_of(const AnimatedPrimitive& primitive, const Appearance& appearance) {
  if (!has_texture(primitive)) return nullptr;
  const MipLevels& texture = appearance.textures[static_cast<std::size_t>(primitive.image)];
  return texture.empty() ? nullptr : &texture;
}

Eigen::Array3f texture_at(const MipLevels& texture, const Eigen::Vector2f& uv, float level) {
  const float last = static_cast<float>(texture.size()) - 1;
  const float clamped = std::clamp(level, 0.0f, last);
  const std::size_t fine = static_cast<std::size_t>(clamped);
  const float share = clamped - static_cast<float>(fine);
  const Eigen::Array3f colour = bilinear(texture[fine], uv);
  if (share == 0.0f) return colour;
  return (1 - share) * colour + share * bilinear(texture[fine + 1], uv);
}

Eigen::Array3f base_colour_at(const AnimatedMesh& mesh, const Appearance& appearance,
                              const Float3s& colours, const RayHit& hit, float footprint,
                              float triangle_area) {
  const std::size_t index = static_cast<std::size_t>(hit.primitive);
  const AnimatedPrimitive& primitive = mesh.primitives[index];
  Eigen::Array3f colour = appearance.factors[index];
  if (colours.rows() > 0) colour *= interpolated(colours, primitive.triangles, hit).array();
  const MipLevels* found = texture_of(primitive, appearance);
  if (found != nullptr) {
    const MipLevels& texture = *found;
    const Eigen::Vector2f uv =
        interpolated(primitive.texture_coordinates, primitive.triangles, hit);
    const float level = texture_level(primitive, texture.front(), hit, footprint, triangle_area);
    if (uv.allFinite()) colour *= texture_at(texture, uv, level);
  }
  return colour.max(0.0f).min(1.0f);
}

}  // namespace morphbake
