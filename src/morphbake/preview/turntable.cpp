#include "morphbake/preview/turntable.h"

#include <fmt/core.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <deque>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/preview/appearance.h"
#include "morphbake/preview/captioned_row.h"
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

/// A mesh on the table: what stays from picture to picture is made once.
class MeshOnTable {
 public:
  /// All but the options and the observer must outlive it.
  MeshOnTable(const AnimatedMesh& mesh, const std::vector<LoopMoment>& moments,
              const Framing& framing, const TurntableOptions& options, const Observer& observer)
      : mesh_(mesh),
        moments_(moments),
        framing_(framing),
        width_(options.width),
        height_(options.height),
        appearance_(make_appearance(mesh, observer)),
        studio_(make_studio(options)),
        pattern_(make_sample_pattern(options.samples)),
        poses_(first_poses()),
        rays_(mesh, poses_) {}

  Image picture(std::size_t i) {
    pose(i, poses_);
    rays_.refit();
    const Scene scene{mesh_,   poses_,          rays_,    appearance_,
                      studio_, framing_.camera, pattern_, framing_.floors[i]};
    return render_picture(scene, width_, height_);
  }

 private:
  void pose(std::size_t i, std::vector<PosedPrimitive>& poses) const {
    pose_mesh(mesh_, moments_[i].weights, mesh_to_studio(framing_, moments_[i].azimuth), poses);
  }

  std::vector<PosedPrimitive> first_poses() const {
    std::vector<PosedPrimitive> poses;
    pose(0, poses);
    return poses;
  }

  const AnimatedMesh& mesh_;
  const std::vector<LoopMoment>& moments_;
  const Framing& framing_;
  int width_;
  int height_;
  Appearance appearance_;
  Studio studio_;
  SamplePattern pattern_;
  std::vector<PosedPrimitive> poses_;
  RayScene rays_;  // shares the memory of poses_
};

/// The moments of all subjects on one clock.
std::vector<std::vector<LoopMoment>> moments_of(const std::vector<TurntableSubject>& subjects,
                                                const TurntableOptions& options) {
  std::vector<PlayedSpan> spans;
  for (const TurntableSubject& subject : subjects) spans.push_back(played_span(subject.mesh));
  const PlayedSpan span = common_span(spans);
  std::vector<std::vector<LoopMoment>> moments;
  for (const TurntableSubject& subject : subjects) {
    moments.push_back(loop_moments(subject.mesh, span, options));
  }
  return moments;
}

}  // namespace

std::vector<Image> render_turntable(const AnimatedMesh& mesh, const TurntableOptions& options,
                                    const Observer& observer) {
  check(options);
  advance(observer, {"preview", 0, options.frames});
  tbb::task_arena arena(thread_count(options));
  const std::vector<LoopMoment> moments = loop_moments(mesh, played_span(mesh), options);
  const Framing framing = arena.execute([&] { return frame_motion(mesh, moments, options); });
  MeshOnTable on_table(mesh, moments, framing, options, observer);
  std::vector<Image> pictures;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    pictures.push_back(arena.execute([&] { return on_table.picture(i); }));
    advance(observer, {"preview", static_cast<int>(i) + 1, options.frames});
  }
  return pictures;
}

std::vector<Image> render_side_by_side(const std::vector<TurntableSubject>& subjects,
                                       const TurntableOptions& options, const Observer& observer) {
  check(options);
  const int total = options.frames * static_cast<int>(subjects.size());
  advance(observer, {"preview", 0, total});
  tbb::task_arena arena(thread_count(options));
  const std::vector<std::vector<LoopMoment>> moments = moments_of(subjects, options);
  std::vector<FramedMotion> motions;
  std::vector<std::string> labels;
  for (std::size_t k = 0; k < subjects.size(); ++k) {
    motions.push_back({subjects[k].file, subjects[k].mesh, moments[k]});
    labels.push_back(subjects[k].label);
  }
  const std::vector<Framing> framings =
      arena.execute([&] { return frame_side_by_side(motions, options); });
  std::deque<MeshOnTable> on_table;  // they cannot move
  for (std::size_t k = 0; k < subjects.size(); ++k) {
    on_table.emplace_back(subjects[k].mesh, moments[k], framings[k], options, observer);
  }
  std::vector<Image> rows;
  int done = 0;
  for (std::size_t i = 0; i < moments.front().size(); ++i) {
    std::vector<Image> pictures;
    for (MeshOnTable& each : on_table) {
      pictures.push_back(arena.execute([&] { return each.picture(i); }));
      advance(observer, {"preview", ++done, total});
    }
    rows.push_back(
        captioned_row(pictures, labels, fmt::format("{:.2f} s", moments.front()[i].time)));
  }
  return rows;
}

}  // namespace morphbake
