#include "morphbake/preview/pixel_light.h"

#include <algorithm>
#include <cmath>

#include "morphbake/preview/sampling.h"

namespace morphbake {
namespace {

constexpr int kReach = kPatternSide / 2;

/// How surely two pixels show the same surface: 1 for equal normals and distances, towards 0
/// otherwise.
float same_surface(const PixelLight& a, const PixelLight& b) {
  const Eigen::Vector3f na = a.normal / a.subject, nb = b.normal / b.subject;
  const float bend = (na - nb).squaredNorm();
  const float step = (a.distance / a.subject - b.distance / b.subject) / 0.05f;
  return std::exp(-4 * bend - step * step);
}

}  // namespace

SmoothVisibility filter_visibility(const LightBuffer& buffer, int x, int y) {
  const PixelLight& centre = buffer.at(x, y);
  Visibility subject_key, subject_room, floor_key, floor_room;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      // At the picture's border the pattern is completed by the pixel one period further in.
      const int px = x + dx < 0               ? x + dx + kPatternSide
                     : x + dx >= buffer.width ? x + dx - kPatternSide
                                              : x + dx;
      const int py = y + dy < 0                ? y + dy + kPatternSide
                     : y + dy >= buffer.height ? y + dy - kPatternSide
                                               : y + dy;
      const PixelLight& pixel = buffer.at(px, py);
      const float weight =
          (std::abs(dx) == kReach ? 0.5f : 1.0f) * (std::abs(dy) == kReach ? 0.5f : 1.0f);
      floor_key.add(pixel.floor_key, weight);
      floor_room.add(pixel.floor_room, weight);
      if (centre.subject == 0 || pixel.subject == 0) continue;
      const float same = weight * same_surface(centre, pixel);
      subject_key.add(pixel.subject_key, same);
      subject_room.add(pixel.subject_room, same);
    }
  }
  return {subject_key.share(), subject_room.share(), floor_key.share(), floor_room.share()};
}

}  // namespace morphbake
