#pragma once

#include <Eigen/Core>

#include "morphbake/preview/turntable.h"

namespace morphbake {

/// A soft box to the camera's left and above, a bright room around, and a backdrop without a
/// horizon. Stands still with the camera; units are such that a white surface facing all lights is
/// about 1.
struct Studio {
  Eigen::Vector3f key_direction;  ///< towards the soft box's middle, unit length
  Eigen::Vector3f key_across;     ///< axes of the soft box, scaled by its radius at distance 1
  Eigen::Vector3f key_upward;
  float key_radius = 0;      ///< tangent of half the angle that the soft box is seen at
  Eigen::Array3f key_light;  ///< irradiance over pi on a surface that faces it
  Eigen::Matrix<float, 9, 3>
      room;                 ///< spherical harmonics of the room's irradiance over pi, to band 2
  Eigen::Array3f backdrop;  ///< linear RGB of its middle
};

Studio make_studio(const TurntableOptions& options);

/// Light that comes from `direction` (unit length) of the room, without the soft box.
Eigen::Array3f room_radiance(const Eigen::Vector3f& direction);

/// The room's irradiance over pi on a surface with this normal when nothing is in the way.
Eigen::Array3f room_irradiance(const Studio& studio, const Eigen::Vector3f& normal);

/// Share of the soft box's light that a surface receives when nothing is in the way: the cosine,
/// softened where the box sets behind the surface.
float key_cosine(const Studio& studio, const Eigen::Vector3f& normal);

/// Share of the key light that a satin surface reflects to the viewer (GGX).
/// @param to_viewer  unit length
float key_gloss(const Studio& studio, const Eigen::Vector3f& normal,
                const Eigen::Vector3f& to_viewer);

/// Share of the light around that a satin surface mirrors at this angle (Schlick's approximation).
float mirror_share(float cosine);

/// Linear RGB of the backdrop at a place in the picture (0, 0 to 1, 1), brightest behind the
/// subject.
Eigen::Array3f backdrop_at(const Studio& studio, float x, float y);

/// Display value of linear light: exact for the darker part, rolled off softly towards white.
Eigen::Array3f tone_mapped(const Eigen::Array3f& light);

}  // namespace morphbake
