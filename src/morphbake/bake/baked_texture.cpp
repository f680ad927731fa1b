#include "morphbake/bake/baked_texture.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <utility>

#include "morphbake/atlas/paint_atlas.h"
#include "morphbake/images/images.h"
#include "morphbake/json/json.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/facing_point.h"
#include "morphbake/mesh/surface_point.h"

namespace morphbake {
namespace {

Eigen::Vector3d normal_of(const Mesh& mesh, int triangle) {
  const auto corner = [&](int k) {
    return Eigen::Vector3d(mesh.positions.row(mesh.triangles(triangle, k)).transpose());
  };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

/// Colours of a row: each search begins where the one before it ended, or at a corner of a new
/// triangle, which is known to lie on the source.
std::vector<Eigen::Array3f> row_colours(const Mesh& remeshed,
                                        const std::vector<SurfacePoint>& on_source,
                                        const FacingPoints& search, const SurfaceColours& colours,
                                        const std::vector<AtlasTexel>& texels) {
  std::vector<Eigen::Array3f> row;
  SurfacePoint near;
  int last = -1;
  for (const AtlasTexel& texel : texels) {
    if (texel.at.triangle != last) {
      near = on_source[static_cast<std::size_t>(nearest_corner(remeshed, texel.at))];
    }
    last = texel.at.triangle;
    near = search.find(position_of(remeshed, texel.at), normal_of(remeshed, last), near);
    row.push_back(colour_at(colours, near, texel.width));
  }
  return row;
}

/// As make_atlas; problems are those of the recipe's field.
Atlas atlas_of(const Recipe& recipe, const Mesh& mesh,
               const std::vector<Eigen::Vector2i>& hard_edges, const Observer& observer) {
  const TextureRequest& request = *recipe.connectivity.texture;
  try {
    return make_atlas(mesh, hard_edges, {request.size, request.padding}, observer);
  } catch (const BakeError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      problem.location = location_in(recipe, "/connectivity/texture/size");
    }
    throw BakeError(std::move(problems));
  }
}

}  // namespace

SurfaceColours texture_colours(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                               const std::vector<SourceSurface>& surfaces,
                               const Observer& observer) {
  const auto of = static_cast<std::size_t>(recipe.connectivity.texture->of);
  SurfaceColours colours = surface_colours(sources[of], surfaces[of], observer);
  if (colours.any()) return colours;
  throw BakeError({Severity::Error, "connectivity.no-colours",
                   location_in(recipe, "/connectivity/texture/of"),
                   fmt::format("\"{}\" has one colour everywhere: no texture with texture "
                               "coordinates, and no vertex colours",
                               sources[of].name),
                   "name a source that has a texture, or leave the field \"texture\" out"});
}

BakedTexture bake_texture(const Recipe& recipe, const SourceSurface& surface,
                          const SurfaceColours& colours, const SharedTriangulation& triangulation,
                          const Observer& observer) {
  const TextureRequest& request = *recipe.connectivity.texture;
  const auto of = static_cast<std::size_t>(request.of);
  const Mesh remeshed{triangulation.geometries[of], triangulation.connectivity.triangles};
  BakedTexture baked;
  baked.atlas = atlas_of(recipe, remeshed, triangulation.hard_edges, observer);
  const FacingPoints search(surface.mesh);
  const Image image = paint_atlas(
      baked.atlas, remeshed,
      [&](const std::vector<AtlasTexel>& texels) {
        return row_colours(remeshed, triangulation.on_source[of], search, colours, texels);
      },
      observer);
  baked.material = colours.material;
  baked.material.base_colour.setOnes();
  baked.material.base_colour_image = encode_png(image);
  return baked;
}

}  // namespace morphbake
