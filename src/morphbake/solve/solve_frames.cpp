#include "morphbake/solve/solve_frames.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

namespace morphbake {
namespace {

constexpr std::size_t kFramesPerSolve = 16;   // columns of one pass over the factor: 48
constexpr std::size_t kFramesPerGoals = 8;    // which share passes as well, where they need any
constexpr std::size_t kFewestPerPass = 4;     // fewer would read the factor for too little
constexpr std::size_t kFramesLookedBack = 2;  // whose solutions the next ones start from
constexpr double kChunkBytes = 256e6;
constexpr double kBytesPerVertexAndFrame = 96;  // differences, blend, unknowns, residual

std::size_t chunk_length(const DisplacementSystem& system) {
  const auto vertices = static_cast<double>(system.components().label.size());
  const double frames = kChunkBytes / (kBytesPerVertexAndFrame * std::max(1.0, vertices));
  return static_cast<std::size_t>(std::clamp(frames, 8.0, 64.0));
}

/// A chunk of frames while it is solved.
struct Chunk {
  std::vector<Goal> goals;
  std::vector<Eigen::MatrixXd> x;  ///< starts, then solutions
  std::vector<Convergence> reached;
};

/// How far a frame's solution is from its blend.
Eigen::MatrixXd deviation(const SurfaceSolver& solver, const Chunk& chunk, std::size_t frame) {
  return chunk.x[frame] - solver.system().start(chunk.goals[frame]);
}

/// How many frames share a pass: all threads shall have one. No frame sees another, so this changes
/// the time, and no byte.
std::size_t frames_a_pass(std::size_t count) {
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  return std::clamp((count + threads - 1) / threads, kFewestPerPass, kFramesPerSolve);
}

/// Solves frames that do not need one another, several a pass, passes over threads.
void solve_independent(const SurfaceSolver& solver, Chunk& chunk,
                       std::vector<std::size_t> members) {
  std::erase_if(members, [&](std::size_t i) {
    const bool is_known = chunk.goals[i].is_blend();
    if (is_known) chunk.x[i] = solver.system().start(chunk.goals[i]);
    return is_known;
  });
  const std::size_t length = frames_a_pass(members.size());
  const std::size_t passes = (members.size() + length - 1) / length;
  tbb::parallel_for(std::size_t{0}, passes, [&](std::size_t pass) {
    const std::size_t begin = pass * length;
    const std::size_t end = std::min(members.size(), begin + length);
    std::vector<Goal> goals;
    std::vector<Eigen::MatrixXd> x;
    for (std::size_t i = begin; i < end; ++i) {
      goals.push_back(std::move(chunk.goals[members[i]]));
      x.push_back(std::move(chunk.x[members[i]]));
    }
    const std::vector<Convergence> reached = solver.solve(goals, x);
    for (std::size_t i = begin; i < end; ++i) {
      chunk.goals[members[i]] = std::move(goals[i - begin]);
      chunk.x[members[i]] = std::move(x[i - begin]);
      chunk.reached[members[i]] = reached[i - begin];
    }
  });
}

/// All at once; `warm` from what the last frame before them deviates by.
void solve_together(const SurfaceSolver& solver, Chunk& chunk,
                    const std::vector<Eigen::MatrixXd>& before) {
  const bool starts_warm = solver.choice().solver == Solver::Warm && !before.empty();
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < chunk.x.size(); ++i) {
    if (chunk.goals[i].is_blend()) continue;
    members.push_back(i);
    if (starts_warm) chunk.x[i] += before.back();
    if (i + kFramesLookedBack < chunk.x.size()) chunk.goals[i].start.resize(0, 3);  // is done with
  }
  solve_independent(solver, chunk, std::move(members));
}

/// @param last  deviations of the two frames before the chunk, the newest last
void solve_in_order(const SurfaceSolver& solver, Chunk& chunk, std::vector<Eigen::MatrixXd> last) {
  for (std::size_t i = 0; i < chunk.x.size(); ++i) {
    const std::size_t known = last.size();
    if (known == 1) chunk.x[i] += last[0];
    if (known == 2) chunk.x[i] += 2 * last[1] - last[0];
    solve_independent(solver, chunk, {i});
    if (known == 2) last.erase(last.begin());
    last.push_back(deviation(solver, chunk, i));
  }
}

std::vector<Eigen::MatrixXd> last_two_deviations(const SurfaceSolver& solver, const Chunk& chunk) {
  std::vector<Eigen::MatrixXd> last;
  for (std::size_t i = chunk.x.size() - std::min(kFramesLookedBack, chunk.x.size());
       i < chunk.x.size(); ++i) {
    last.push_back(deviation(solver, chunk, i));
  }
  return last;
}

void solve_chunk(const SurfaceSolver& solver, Chunk& chunk,
                 const std::vector<Eigen::MatrixXd>& before) {
  if (solver.is_iterative()) {
    solve_in_order(solver, chunk, before);
  } else {
    solve_together(solver, chunk, before);
  }
}

}  // namespace

std::vector<SolveRecord> solve_frames(const SurfaceSolver& solver, const std::vector<double>& times,
                                      const GoalsAt& goals_at, const Observer& observer,
                                      const FrameConsumer& consumer) {
  const DisplacementSystem& system = solver.system();
  const std::size_t length = chunk_length(system);
  std::vector<SolveRecord> records;
  std::vector<Eigen::MatrixXd> before;
  for (std::size_t first = 0; first < times.size(); first += length) {
    advance(observer, {"solve", static_cast<int>(first), static_cast<int>(times.size())});
    Chunk chunk;
    const std::size_t frames = std::min(length, times.size() - first);
    chunk.goals.resize(frames);
    chunk.x.resize(frames);
    chunk.reached.resize(frames);
    const std::size_t together = std::min(frames_a_pass(frames), kFramesPerGoals);
    const std::size_t batches = (frames + together - 1) / together;
    tbb::parallel_for(std::size_t{0}, batches, [&](std::size_t batch) {
      stop_if_cancelled(observer);
      const std::size_t begin = batch * together;
      const std::size_t end = std::min(frames, begin + together);
      std::vector<Goal> goals = goals_at({times.data() + first + begin, end - begin});
      for (std::size_t i = begin; i < end; ++i) {
        chunk.goals[i] = std::move(goals[i - begin]);
        chunk.x[i] = system.start(chunk.goals[i]);
      }
    });
    solve_chunk(solver, chunk, before);
    before = last_two_deviations(solver, chunk);
    tbb::parallel_for(std::size_t{0}, frames, [&](std::size_t i) {
      chunk.goals[i].differences.resize(0, 3);
      chunk.x[i] = system.displacement(chunk.goals[i], chunk.x[i]);
    });
    for (std::size_t i = 0; i < frames; ++i) {
      consumer(static_cast<int>(first + i), chunk.x[i]);
      if (chunk.goals[i].is_blend()) continue;
      records.push_back({"", times[first + i], chunk.reached[i]});
    }
  }
  return records;
}

}  // namespace morphbake
