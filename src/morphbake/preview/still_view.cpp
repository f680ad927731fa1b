#include "morphbake/preview/still_view.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <Eigen/LU>
#include <algorithm>
#include <numbers>

#include "morphbake/preview/appearance.h"
#include "morphbake/preview/framing.h"
#include "morphbake/preview/picture.h"
#include "morphbake/preview/pose.h"
#include "morphbake/preview/ray_scene.h"
#include "morphbake/preview/sampling.h"
#include "morphbake/preview/studio.h"

namespace morphbake {
namespace {

/// A point may lie this far behind the first surface and still be on it; the shape's radius is 1.
constexpr float kOnSurface = 0.03f;

SeenPoint seen(const Camera& camera, const RayScene& rays, const TurntableOptions& options,
               const Eigen::Vector3f& point) {
  const Eigen::Vector3f to_point = point - camera.position;
  const float depth = to_point.dot(camera.forward);
  const float across = (to_point.dot(camera.right) / depth - camera.shift.x()) / camera.half_width;
  const float upward = (to_point.dot(camera.up) / depth - camera.shift.y()) / camera.half_height;
  SeenPoint result;
  result.pixel = {(across + 1) / 2 * static_cast<float>(options.width),
                  (1 - upward) / 2 * static_cast<float>(options.height)};
  const float distance = to_point.norm();
  result.is_hidden =
      rays.is_occluded(camera.position, to_point, std::max(0.0f, 1 - kOnSurface / distance));
  return result;
}

}  // namespace

StillView render_still(const AnimatedMesh& mesh, const TurntableOptions& options,
                       const Positions& points, const Observer& observer) {
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);
  const double azimuth = options.azimuth * std::numbers::pi / 180;
  const std::vector<LoopMoment> moments = {{weights_at(mesh, 0), azimuth}};
  const Framing framing = arena.execute([&] { return frame_motion(mesh, moments, options); });
  const Appearance appearance = make_appearance(mesh, observer);
  const Studio studio = make_studio(options);
  const SamplePattern pattern = make_sample_pattern(options.samples);
  const Eigen::Affine3d to_studio = mesh_to_studio(framing, azimuth);
  std::vector<PosedPrimitive> poses;
  pose_mesh(mesh, moments[0].weights, to_studio, poses);
  const RayScene rays(mesh, poses);
  const Scene scene{mesh,   poses,          rays,    appearance,
                    studio, framing.camera, pattern, framing.floors[0]};
  StillView view;
  view.picture =
      arena.execute([&] { return render_picture(scene, options.width, options.height); });
  const Eigen::Affine3d from_scene = to_studio * Eigen::Affine3d(mesh.to_scene.inverse());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::Vector3d point = from_scene * Eigen::Vector3d(points.row(i));
    view.points.push_back(seen(framing.camera, rays, options, point.cast<float>()));
  }
  return view;
}

}  // namespace morphbake
