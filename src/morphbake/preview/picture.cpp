#include "morphbake/preview/picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "morphbake/images/srgb.h"
#include "morphbake/preview/pixel_light.h"

namespace morphbake {
namespace {

constexpr float kLift = 2e-4f;  ///< rays start this far above a surface; the subject's radius is 1
constexpr float kFloorNear = 2.6f;  ///< shadows on the floor fade out between these distances
constexpr float kFloorFar = 4.2f;
constexpr float kFloorContact =
    0.22f;  ///< height at which the floor below is half as bright as afar

/// How the floor hands light on to itself below the subject; what is seen of it is the backdrop's
/// colour.
const Eigen::Array3f kFloorColour{0.5f, 0.48f, 0.46f};

/// What a camera ray meets of the subject, seen from the viewer's side.
struct VisiblePoint {
  Eigen::Vector3f origin;  ///< for further rays: lifted off the surface
  Eigen::Vector3f normal;  ///< shading normal, unit length
  Eigen::Array3f base_colour;
  float distance = 0;
};

Eigen::Vector3f corner(const Float3s& rows, int vertex) { return rows.row(vertex).transpose(); }

/// Where a smooth surface through the corners with these normals would lie. Rays from there do not
/// meet the coarse triangles around, which otherwise cut the lit side off in steps.
/// @see Hanika 2021, Hacking the shadow terminator
Eigen::Vector3f smooth_position(const Eigen::Vector3f& position, const Eigen::Matrix3f& corners,
                                const Eigen::Matrix3f& normals, const Eigen::Vector3f& weights) {
  Eigen::Vector3f result = position;
  for (int k = 0; k < 3; ++k) {
    const float below = std::min(0.0f, (position - corners.col(k)).dot(normals.col(k)));
    result -= weights[k] * below * normals.col(k);
  }
  return result;
}

VisiblePoint visible_point(const Scene& scene, const RayHit& hit, const Eigen::Vector3f& direction,
                           float footprint) {
  const std::size_t index = static_cast<std::size_t>(hit.primitive);
  const auto triangle = scene.mesh.primitives[index].triangles.row(hit.triangle);
  const PosedPrimitive& pose = scene.poses[index];
  Eigen::Matrix3f corners;
  for (int k = 0; k < 3; ++k) corners.col(k) = corner(pose.positions, triangle[k]);

  VisiblePoint point;
  point.distance = hit.distance * direction.norm();
  const Eigen::Vector3f position = corners * hit.barycentric;
  Eigen::Vector3f face = hit.face_normal.normalized();
  if (face.dot(direction) > 0) face = -face;
  point.normal = face;
  point.origin = position;
  if (pose.normals.rows() > 0) {
    Eigen::Matrix3f normals;
    for (int k = 0; k < 3; ++k) {
      normals.col(k) = corner(pose.normals, triangle[k]);
      if (normals.col(k).dot(face) < 0) normals.col(k) = -normals.col(k);
    }
    const Eigen::Vector3f mean = (normals * hit.barycentric).normalized();
    if (mean.squaredNorm() > 0.5f) {  // false for zero and for NaN
      point.normal = mean;
      point.origin = smooth_position(position, corners, normals, hit.barycentric);
    }
  }
  point.origin += kLift * face;
  point.base_colour = base_colour_at(scene.mesh, scene.appearance, pose.colours, hit,
                                     footprint * point.distance, hit.face_normal.norm() / 2);
  return point;
}

/// The soft box as seen through sample `disk`.
Eigen::Vector3f key_sample(const Studio& studio, const Eigen::Vector2f& disk) {
  return (studio.key_direction + disk.x() * studio.key_across + disk.y() * studio.key_upward)
      .normalized();
}

Visibility key_visibility(const Scene& scene, const Eigen::Vector3f& origin,
                          const Eigen::Vector3f& normal, const Eigen::Vector2f& disk) {
  const Eigen::Vector3f direction = key_sample(scene.studio, disk);
  const float cosine = normal.dot(direction);
  if (cosine <= 0) return {};
  const bool is_hidden =
      scene.rays.is_occluded(origin, direction, std::numeric_limits<float>::infinity());
  return {is_hidden ? 0.0f : cosine, cosine};
}

/// Weighted by how bright the room is there. Rays that go down end on the floor, which is itself in
/// the subject's shade close below it.
Visibility room_visibility(const Scene& scene, const VisiblePoint& point,
                           const Eigen::Vector3f& local) {
  Eigen::Vector3f a, b;
  perpendicular_axes(point.normal, a, b);
  const Eigen::Vector3f direction = local.x() * a + local.y() * b + local.z() * point.normal;
  const float light = room_radiance(direction).sum();
  const float height = std::max(0.0f, point.origin.y() - scene.floor);
  const bool meets_floor = direction.y() < -1e-4f;
  const float far = meets_floor ? height / -direction.y() : std::numeric_limits<float>::infinity();
  if (scene.rays.is_occluded(point.origin, direction, far)) return {0.0f, light};
  return {meets_floor ? light * height / (height + kFloorContact) : light, light};
}

void add_subject(const Scene& scene, const VisiblePoint& point, const Eigen::Vector3f& direction,
                 std::size_t sample, PixelLight& pixel) {
  const Studio& studio = scene.studio;
  const Eigen::Vector3f to_viewer = -direction.normalized();
  const float facing = point.normal.dot(to_viewer);
  const Eigen::Vector3f mirrored = 2 * facing * point.normal - to_viewer;
  pixel.subject += 1;
  pixel.base_colour += point.base_colour;
  pixel.normal += point.normal;
  pixel.distance += point.distance;
  pixel.key += studio.key_light * (point.base_colour * key_cosine(studio, point.normal) +
                                   key_gloss(studio, point.normal, to_viewer));
  pixel.room += point.base_colour * room_irradiance(studio, point.normal) +
                0.6f * mirror_share(facing) * room_irradiance(studio, mirrored);
  pixel.subject_key.add(
      key_visibility(scene, point.origin, point.normal, scene.pattern.disk[sample]), 1);
  pixel.subject_room.add(room_visibility(scene, point, scene.pattern.hemisphere[sample]), 1);
}

void add_floor(const Scene& scene, const Eigen::Vector3f& direction, std::size_t sample,
               PixelLight& pixel) {
  const float drop = scene.camera.position.y() - scene.floor;
  if (direction.y() >= -1e-4f || drop <= 0) return;
  Eigen::Vector3f origin = scene.camera.position + direction * (drop / -direction.y());
  origin.y() = scene.floor;
  const float away = std::sqrt(origin.x() * origin.x() + origin.z() * origin.z());
  if (away >= kFloorFar) return;
  const float fade = std::clamp((kFloorFar - away) / (kFloorFar - kFloorNear), 0.0f, 1.0f);
  const Eigen::Vector3f up = Eigen::Vector3f::UnitY();
  pixel.floor += fade * fade * (3 - 2 * fade);
  pixel.floor_key.add(key_visibility(scene, origin, up, scene.pattern.disk[sample]), 1);
  const Eigen::Vector3f& local = scene.pattern.hemisphere[sample];
  const Eigen::Vector3f skyward(local.x(), local.z(), local.y());
  const float light = room_radiance(skyward).sum();
  const bool is_hidden =
      scene.rays.is_occluded(origin, skyward, std::numeric_limits<float>::infinity());
  pixel.floor_room.add({is_hidden ? 0.0f : light, light}, 1);
}

PixelLight trace_pixel(const Scene& scene, const LightBuffer& buffer, int x, int y) {
  const float footprint = 2 * scene.camera.half_height / static_cast<float>(buffer.height);
  const std::size_t first = scene.pattern.first_of_pixel(x, y);
  PixelLight pixel;
  for (std::size_t s = 0; s < scene.pattern.lens.size(); ++s) {
    const Eigen::Vector2f& lens = scene.pattern.lens[s];
    const Eigen::Vector3f direction = view_direction(
        scene.camera, (static_cast<float>(x) + lens.x()) / static_cast<float>(buffer.width),
        (static_cast<float>(y) + lens.y()) / static_cast<float>(buffer.height));
    const auto hit = scene.rays.first_hit(scene.camera.position, direction);
    if (hit) {
      add_subject(scene, visible_point(scene, *hit, direction, footprint / 2), direction, first + s,
                  pixel);
    } else {
      add_floor(scene, direction, first + s, pixel);
    }
  }
  return pixel;
}

/// Light that reaches a hollow after several bounces inside it: less dark, and more coloured.
/// @see Jimenez et al. 2016, Practical realtime strategies for accurate indirect occlusion, eq. 10
Eigen::Array3f bounced(float share, const Eigen::Array3f& base_colour) {
  const Eigen::Array3f a = 2.0404f * base_colour - 0.3324f;
  const Eigen::Array3f b = -4.7951f * base_colour + 0.6417f;
  const Eigen::Array3f c = 2.7552f * base_colour + 0.6903f;
  return (((share * a + b) * share + c) * share).max(share);
}

Eigen::Array3f floor_light(const Scene& scene, const PixelLight& pixel,
                           const SmoothVisibility& seen, const Eigen::Array3f& backdrop) {
  const float misses = static_cast<float>(scene.pattern.samples) - pixel.subject;
  if (pixel.floor <= 0 || misses <= 0) return backdrop;
  const Eigen::Vector3f up = Eigen::Vector3f::UnitY();
  const Eigen::Array3f key = scene.studio.key_light * key_cosine(scene.studio, up);
  const Eigen::Array3f room = room_irradiance(scene.studio, up);
  const Eigen::Array3f share =
      (key * seen.floor_key + room * bounced(seen.floor_room, kFloorColour)) / (key + room);
  return backdrop * (1 - (pixel.floor / misses) * (1 - share));
}

Eigen::Array3f developed(const Scene& scene, const LightBuffer& buffer, int x, int y) {
  const PixelLight& pixel = buffer.at(x, y);
  const Eigen::Array3f backdrop =
      backdrop_at(scene.studio, (static_cast<float>(x) + 0.5f) / static_cast<float>(buffer.width),
                  (static_cast<float>(y) + 0.5f) / static_cast<float>(buffer.height));
  if (pixel.subject == 0 && pixel.floor == 0) return backdrop;
  const SmoothVisibility seen = filter_visibility(buffer, x, y);
  const Eigen::Array3f ground = floor_light(scene, pixel, seen, backdrop);
  if (pixel.subject == 0) return ground;
  const Eigen::Array3f light =
      pixel.key * seen.subject_key +
      pixel.room * bounced(seen.subject_room, pixel.base_colour / pixel.subject);
  const float coverage = pixel.subject / static_cast<float>(scene.pattern.samples);
  return coverage * tone_mapped(light / pixel.subject) + (1 - coverage) * ground;
}

}  // namespace

Image render_picture(const Scene& scene, int width, int height) {
  LightBuffer buffer{width, height, {}};
  buffer.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) buffer.at(x, y) = trace_pixel(scene, buffer, x, y);
  });
  Image image{width, height, {}};
  image.rgb.resize(buffer.pixels.size() * 3);
  tbb::parallel_for(0, height, [&](int y) {
    std::uint8_t* rgb =
        &image.rgb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * 3];
    for (int x = 0; x < width; ++x) {
      const Eigen::Array3f light = developed(scene, buffer, x, y);
      for (int k = 0; k < 3; ++k) *rgb++ = linear_to_srgb(light[k]);
    }
  });
  return image;
}

}  // namespace morphbake
