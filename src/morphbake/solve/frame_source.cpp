#include "morphbake/solve/frame_source.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
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

  Positions read(const FramePart& part) const {
    Positions positions(part.count, 3);
    const auto count = static_cast<std::size_t>(positions.size());
    const auto row = static_cast<off_t>(part.frame) * vertex_count_ + part.first;
    const std::lock_guard<std::mutex> lock(reading_);  // of the one place in the file
    if (::fseeko(file_.get(), 3 * row * static_cast<off_t>(sizeof(double)), SEEK_SET) != 0) fail();
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
  mutable std::mutex reading_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace

FrameSource combined_frames(const SolvedShapes& shapes, const SeparableTimeline& separable,
                            const Timeline& timeline) {
  const std::vector<double> times = frame_times(timeline);
  std::vector<Eigen::VectorXd> phi;
  for (const double time : times) phi.push_back(field_coefficients(timeline, separable, time));
  return {times, shapes.base.rows(), [&shapes, phi = std::move(phi)](const FramePart& part) {
            return combine_shapes(shapes, phi[part.frame], part.first, part.count);
          }};
}

SolvedFrames solved_frames(const SurfaceSolver& solver, const Positions& reference,
                           const std::vector<double>& times, const GoalsAt& goals_at,
                           const Observer& observer) {
  const auto file = std::make_shared<FrameFile>(reference.rows());
  std::vector<SolveRecord> records = solve_frames(
      solver, times, goals_at, observer,
      [&](int, const Positions& displacement) { file->append(reference + displacement); });
  return {{times, reference.rows(), [file](const FramePart& part) { return file->read(part); }},
          std::move(records)};
}

}  // namespace morphbake
