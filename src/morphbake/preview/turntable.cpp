#include "morphbake/preview/turntable.h"

#include <fmt/core.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/preview/appearance.h"
#include "morphbake/preview/framing.h"
#include "morphbake/preview/motion.h"
#include "morphbake/preview/picture.h"
#include "morphbake/preview/pose.h"
#include "morphbake/preview/ray_scene.h"
#include "morphbake/preview/sampling.h"
#include "morphbake/preview/studio.h"

namespace morphbake {
namespace {

void check_range(const char* name, double value, double low, double high,
                 std::vector<Problem>& problems) {
  if (value >= low && value <= high) return;  // false for NaN
  Problem problem;
  problem.code = "preview.bad-option";
  problem.message = fmt::format("turntable {} is {}", name, value);
  problem.hint = fmt::format("{} to {}", low, high);
  problems.push_back(std::move(problem));
}

void check(const TurntableOptions& options) {
  std::vector<Problem> problems;
  check_range("width", options.width, 16, 4096, problems);
  check_range("height", options.height, 16, 4096, problems);
  check_range("frames", options.frames, 1, 10000, problems);
  check_range("samples", options.samples, 1, 1024, problems);
  check_range("orbit", options.orbit, -3600, 3600, problems);
  check_range("azimuth", options.azimuth, -3600, 3600, problems);
  check_range("elevation", options.elevation, -80, 80, problems);
  check_range("field_of_view", options.field_of_view, 2, 90, problems);
  check_range("fill", options.fill, 0.6, 0.85, problems);
  check_range("threads", options.threads, 0, 1024, problems);
  for (const double component : options.background) {
    check_range("background", component, 0, 1, problems);
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
}

/// More threads than cores gain nothing, and TBB complains about them on stderr.
int thread_count(const TurntableOptions& options) {
  const int cores = tbb::info::default_concurrency();
  return options.threads > 0 ? std::min(options.threads, cores) : cores;
}

}  // namespace

std::vector<Image> render_turntable(const AnimatedMesh& mesh, const TurntableOptions& options,
                                    const Observer& observer) {
  check(options);
  advance(observer, {"preview", 0, options.frames});
  tbb::task_arena arena(thread_count(options));
  const std::vector<LoopMoment> moments = loop_moments(mesh, options);
  const Framing framing = arena.execute([&] { return frame_motion(mesh, moments, options); });
  const Appearance appearance = make_appearance(mesh, observer);
  const Studio studio = make_studio(options);
  const SamplePattern pattern = make_sample_pattern(options.samples);

  std::vector<PosedPrimitive> poses;
  pose_mesh(mesh, moments[0].weights, mesh_to_studio(framing, moments[0].azimuth), poses);
  RayScene rays(mesh, poses);
  std::vector<Image> pictures;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    pose_mesh(mesh, moments[i].weights, mesh_to_studio(framing, moments[i].azimuth), poses);
    rays.refit();
    const Scene scene{mesh,   poses,          rays,    appearance,
                      studio, framing.camera, pattern, framing.floors[i]};
    pictures.push_back(
        arena.execute([&] { return render_picture(scene, options.width, options.height); }));
    advance(observer, {"preview", static_cast<int>(i) + 1, options.frames});
  }
  return pictures;
}

}  // namespace morphbake
