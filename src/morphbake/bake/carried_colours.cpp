#include "morphbake/bake/carried_colours.h"

#include "morphbake/bake/surface_colours.h"

namespace morphbake {

CarriedColours carry_colours(const SourceMesh& source, const SourceSurface& surface,
                             const std::vector<SurfacePoint>& points, const Observer& observer) {
  constexpr double kNoWidth = 0;  // of a vertex
  const SurfaceColours look = surface_colours(source, surface, observer);
  CarriedColours carried;
  carried.material = first_material(source.file, source.geometry.mesh);
  if (!look.any()) return carried;
  if (!carried.material) carried.material.emplace();
  carried.material->base_colour.setOnes();
  carried.colours.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    carried.colours.row(static_cast<Eigen::Index>(i)) =
        colour_at(look, points[i], kNoWidth).matrix().transpose();
  }
  return carried;
}

}  // namespace morphbake
