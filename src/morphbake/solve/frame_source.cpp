#include "morphbake/solve/frame_source.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

/// Matrices of one size on disk, in a file without a name.
class FrameFile {
 public:
  explicit FrameFile(Eigen::Index vertex_count)
      : vertex_count_(vertex_count), file_(std::tmpfile(), &std::fclose) {
    if (!file_) fail();
  }

  void append(const Positions& frame) {
    const auto count = static_cast<std::size_t>(frame.size());
    if (std::fwrite(frame.data(), sizeof(double), count, file_.get()) != count) fail();
  }

  Positions read(std::size_t frame) const {
    Positions positions(vertex_count_, 3);
    const auto count = static_cast<std::size_t>(positions.size());
    const auto offset = static_cast<off_t>(frame * count * sizeof(double));
    if (::fseeko(file_.get(), offset, SEEK_SET) != 0) fail();
    if (std::fread(positions.data(), sizeof(double), count, file_.get()) != count) fail();
    return positions;
  }

 private:
  [[noreturn]] static void fail() {
    throw BakeError(Problem{Severity::Error,
                            "output.unwritable",
                            {"temporary file", "", 0, 0},
                            std::string("cannot keep frames: ") + std::strerror(errno),
                            "make room in the folder for temporary files"});
  }

  Eigen::Index vertex_count_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace

FrameSource combined_frames(const SolvedShapes& shapes, const SeparableTimeline& separable,
                            const Timeline& timeline) {
  const std::vector<double> times = frame_times(timeline);
  return {times, [&shapes, &separable, &timeline, times](std::size_t frame) {
            return combine_shapes(shapes, field_coefficients(timeline, separable, times[frame]));
          }};
}

SolvedFrames solved_frames(const SurfaceSolver& solver, const Positions& reference,
                           const std::vector<double>& times, const GoalsAt& goals_at,
                           const Observer& observer) {
  const auto file = std::make_shared<FrameFile>(reference.rows());
  std::vector<SolveRecord> records = solve_frames(
      solver, times, goals_at, observer,
      [&](int, const Positions& displacement) { file->append(reference + displacement); });
  return {{times, [file](std::size_t frame) { return file->read(frame); }}, std::move(records)};
}

}  // namespace morphbake
