#include "morphbake/solve/rotation_passes.h"

#include <algorithm>
#include <cstring>

namespace morphbake {
namespace {

template <class Pass>
void run_anywhere(const Pass& pass) {
  pass();
}

#ifdef __x86_64__
template <class Pass>
[[gnu::target("avx2")]] void run_avx2(const Pass& pass) {
  pass();
}
#endif

/// Runs a pass, which is inlined, with the widest registers that give the same bytes.
template <class Pass>
void run(const Pass& pass) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return run_avx2(pass);
#endif
  run_anywhere(pass);
}

MORPHBAKE_INLINE LaneVector read(const double* row) {
  LaneVector vector;  // copied, because rows are not aligned
  std::memcpy(&vector.x, row, sizeof vector.x);
  std::memcpy(&vector.y, row + kLanes, sizeof vector.y);
  std::memcpy(&vector.z, row + 2 * kLanes, sizeof vector.z);
  return vector;
}

MORPHBAKE_INLINE void add_to(double* row, const LaneVector& vector) {
  const LaneVector sum = read(row) + vector;
  std::memcpy(row, &sum.x, sizeof sum.x);
  std::memcpy(row + kLanes, &sum.y, sizeof sum.y);
  std::memcpy(row + 2 * kLanes, &sum.z, sizeof sum.z);
}

/// What the passes look up for every edge.
struct Reader {
  Reader(const TurnedShapes& turned, const LaneFrames& frames)
      : shapes(turned),
        deformations(*turned.deformations),
        further(deformations.size()),
        shares(frames.shares.data()) {}

  MORPHBAKE_INLINE const LaneNumber* shares_of(int vertex) const {
    return shares + static_cast<std::size_t>(vertex) * (further + 1);
  }

  /// sum_s T_s l_s
  MORPHBAKE_INLINE LaneVector turn(int a, int b, std::size_t edge) const {
    const LaneNumber *at_a = shares_of(a), *at_b = shares_of(b);
    LaneVector sum;
    for (std::size_t s = 0; s < further; ++s) {
      sum = sum + scaled((at_a[s + 1].value + at_b[s + 1].value) / 2, deformations[s].turns[edge]);
    }
    return sum;
  }

  /// sum_s T_s R_s^T (a_s - b_s): the edges of all sources as a vertex sees them unturned.
  MORPHBAKE_INLINE LaneVector unturned(int vertex, int a, int b) const {
    const LaneNumber* at = shares_of(vertex);
    LaneVector sum = scaled(at[0].value, edge(0, a, b));
    for (std::size_t s = 0; s < further; ++s) {
      const Eigen::Matrix3d& back = shapes.back[s][static_cast<std::size_t>(vertex)];
      sum = sum + scaled(at[s + 1].value, back * edge(s + 1, a, b));
    }
    return sum;
  }

  MORPHBAKE_INLINE Eigen::Vector3d edge(std::size_t source, int a, int b) const {
    const Positions& positions = shapes.mesh->geometries[source];
    return (positions.row(a) - positions.row(b)).transpose();
  }

  const TurnedShapes& shapes;
  const std::vector<Deformation>& deformations;
  std::size_t further;
  const LaneNumber* shares;
};

struct LaneMatrix {
  LaneVector columns[3];
};

MORPHBAKE_INLINE LaneMatrix matrix_of(const LaneQuaternion& q) {
  const Lanes x = q.x + q.x, y = q.y + q.y, z = q.z + q.z;
  return {{{1 - (y * q.y + z * q.z), x * q.y + z * q.w, x * q.z - y * q.w},
           {x * q.y - z * q.w, 1 - (x * q.x + z * q.z), y * q.z + x * q.w},
           {x * q.z + y * q.w, y * q.z - x * q.w, 1 - (x * q.x + y * q.y)}}};
}

/// One Newton step from R to the rotation that is nearest to A: (tr(M) I - M) theta = axial(M), M
/// the symmetric part of A R^T. Where A says too little (one edge, a mirrored one-ring) it goes the
/// safe way of Müller et al. 2016.
MORPHBAKE_INLINE LaneQuaternion nearer(const LaneMatrix& A, const LaneQuaternion& rotation) {
  const LaneMatrix R = matrix_of(rotation);
  LaneVector g;
  for (int k = 0; k < 3; ++k) g = g + cross(R.columns[k], A.columns[k]);
  Lanes xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
  for (int k = 0; k < 3; ++k) {
    const LaneVector &p = A.columns[k], &q = R.columns[k];
    xx += p.x * q.x;
    yy += p.y * q.y;
    zz += p.z * q.z;
    xy -= (p.x * q.y + p.y * q.x) / 2;
    xz -= (p.x * q.z + p.z * q.x) / 2;
    yz -= (p.y * q.z + p.z * q.y) / 2;
  }
  // tr(M) I - M, and its adjugate.
  const Lanes a = yy + zz, b = xx + zz, c = xx + yy, trace = xx + yy + zz;
  const Lanes A00 = b * c - yz * yz, A01 = xz * yz - xy * c, A02 = xy * yz - xz * b;
  const Lanes A11 = a * c - xz * xz, A12 = xy * xz - a * yz, A22 = a * b - xy * xy;
  const Lanes determinant = a * A00 + xy * A01 + xz * A02;
  constexpr double kClear = 1e-3;  // of the cube of the trace; a flat one-ring has 0.25
  const auto is_clear = (determinant > kClear * trace * trace * trace) & (trace > 0);
  const Lanes inverse = 1 / (is_clear ? determinant : Lanes{1, 1, 1, 1});
  const Lanes length = trace < 0 ? -trace : trace;
  const Lanes safe = length > 0 ? 1 / (length > 0 ? length : Lanes{1, 1, 1, 1}) : Lanes{};
  const LaneVector newton{(A00 * g.x + A01 * g.y + A02 * g.z) * inverse,
                          (A01 * g.x + A11 * g.y + A12 * g.z) * inverse,
                          (A02 * g.x + A12 * g.y + A22 * g.z) * inverse};
  const LaneVector theta{is_clear ? newton.x : safe * g.x, is_clear ? newton.y : safe * g.y,
                         is_clear ? newton.z : safe * g.z};
  return normalised(lane_rotation_of(theta) * rotation);
}

}  // namespace

LaneFrames::LaneFrames(std::span<const TransitionState> states) {
  const TransitionState& first = states.front();
  shares.resize(static_cast<std::size_t>(first.size()));
  rotations.resize(static_cast<std::size_t>(first.cols()));
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const double* from = states[std::min(lane, states.size() - 1)].data();
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i].value[lane] = from[i];
  }
}

void mix_sources(const TurnedShapes& shapes, LaneFrames& frames) {
  const std::vector<Positions>& sources = shapes.mesh->geometries;
  frames.shape.assign(frames.rotations.size(), {});
  for (std::size_t v = 0; v < frames.shape.size(); ++v) {
    for (std::size_t s = 0; s < sources.size(); ++s) {
      frames.shape[v] = frames.shape[v] + scaled(frames.shares[v * sources.size() + s].value,
                                                 sources[s].row(static_cast<Eigen::Index>(v)));
    }
  }
}

void move_by(const ColumnRows& moves, int group, LaneFrames& frames) {
  const double* row = moves.data() + group * kGroupColumns;
  for (LaneVector& position : frames.shape) {
    position = position + read(row);
    row += moves.cols();
  }
}

void turn_components(const Components& components, std::span<const int> roots,
                     std::span<const LaneQuaternion> rotations, LaneFrames& frames) {
  std::vector<LaneQuaternion> turns(roots.size());
  for (std::size_t c = 0; c < roots.size(); ++c) {
    if (roots[c] < 0) continue;
    turns[c] = rotations[c] * inverse(frames.rotations[static_cast<std::size_t>(roots[c])]);
  }
  for (std::size_t v = 0; v < frames.rotations.size(); ++v) {
    const auto component = static_cast<std::size_t>(components.label[v]);
    if (roots[component] < 0) continue;
    frames.rotations[v] = turns[component] * frames.rotations[v];
    if (!frames.shape.empty()) frames.shape[v] = turned(turns[component], frames.shape[v]);
  }
}

void turn_along_tree(const TurnedShapes& shapes, LaneFrames& frames) {
  const Reader reader(shapes, frames);
  run([&]() __attribute__((always_inline)) {
    for (const TreeStep& step : shapes.tree) {
      const LaneVector turn = reader.turn(step.from, step.to, static_cast<std::size_t>(step.edge));
      const LaneQuaternion along = lane_rotation_of(turn);
      frames.rotations[static_cast<std::size_t>(step.to)] =
          frames.rotations[static_cast<std::size_t>(step.from)] *
          (step.from < step.to ? along : inverse(along));
    }
  });
}

void put_misfits(const TurnedShapes& shapes, const LaneFrames& frames, std::span<const int> unknown,
                 int group, ColumnRows& b) {
  const Reader reader(shapes, frames);
  b.middleCols(group * kGroupColumns, kGroupColumns).setZero();
  double* const rows = b.data() + group * kGroupColumns;
  const Eigen::Index stride = b.cols();
  run([&]() __attribute__((always_inline)) {
    for (std::size_t e = 0; e < shapes.edges->size(); ++e) {
      const Edge edge = (*shapes.edges)[e];
      const auto from = static_cast<std::size_t>(edge.a), to = static_cast<std::size_t>(edge.b);
      const LaneVector misfit = lane_rotation_vector(
          frames.rotations[from] * lane_rotation_of(reader.turn(edge.a, edge.b, e)) *
          inverse(frames.rotations[to]));
      if (unknown[from] >= 0) add_to(rows + stride * unknown[from], -1.0 * misfit);
      if (unknown[to] >= 0) add_to(rows + stride * unknown[to], misfit);
    }
  });
}

void turn_by(const ColumnRows& phi, int group, std::span<const int> unknown, double settled,
             std::span<bool> moves, LaneFrames& frames) {
  const double* const rows = phi.data() + group * kGroupColumns;
  Lanes largest{}, moving{};
  for (int lane = 0; lane < kLanes; ++lane) moving[lane] = moves[static_cast<std::size_t>(lane)];
  run([&]() __attribute__((always_inline)) {
    for (std::size_t v = 0; v < unknown.size(); ++v) {
      if (unknown[v] < 0) continue;
      const LaneVector turn = read(rows + phi.cols() * unknown[v]);
      const Lanes square = dot(turn, turn);
      largest = square > largest ? square : largest;
      LaneQuaternion& rotation = frames.rotations[v];
      const LaneQuaternion next = normalised(lane_rotation_of(turn) * rotation);
      rotation.w = moving > 0 ? next.w : rotation.w;
      rotation.x = moving > 0 ? next.x : rotation.x;
      rotation.y = moving > 0 ? next.y : rotation.y;
      rotation.z = moving > 0 ? next.z : rotation.z;
    }
  });
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(largest[lane] > settled * settled)) moves[static_cast<std::size_t>(lane)] = false;
  }
}

void put_differences(const TurnedShapes& shapes, const LaneFrames& frames, Left what, int group,
                     ColumnRows& b) {
  const Reader reader(shapes, frames);
  b.middleCols(group * kGroupColumns, kGroupColumns).setZero();
  double* const rows = b.data() + group * kGroupColumns;
  const Eigen::Index stride = b.cols();
  run([&]() __attribute__((always_inline)) {
    for (const Edge edge : *shapes.edges) {
      const auto from = static_cast<std::size_t>(edge.a), to = static_cast<std::size_t>(edge.b);
      const LaneVector at_a =
          turned(frames.rotations[from], reader.unturned(edge.a, edge.a, edge.b));
      const LaneVector at_b = turned(frames.rotations[to], reader.unturned(edge.b, edge.a, edge.b));
      LaneVector left = 0.5 * (at_a + at_b);
      if (what == Left::Residual) left = left - (frames.shape[from] - frames.shape[to]);
      add_to(rows + stride * edge.a, left);
      add_to(rows + stride * edge.b, -1.0 * left);
    }
  });
}

void fit_rotations(const TurnedShapes& shapes, double relaxation, LaneFrames& frames) {
  constexpr int kSteps = 2;  // from close by; each squares what is left
  const Reader reader(shapes, frames);
  run([&]() __attribute__((always_inline)) {
    for (std::size_t v = 0; v < frames.rotations.size(); ++v) {
      const auto vertex = static_cast<int>(v);
      LaneMatrix A;
      for (int n = shapes.rings.offsets[v]; n < shapes.rings.offsets[v + 1]; ++n) {
        const int j = shapes.rings.neighbours[static_cast<std::size_t>(n)];
        const LaneVector before = reader.unturned(vertex, vertex, j);
        const LaneVector after = frames.shape[v] - frames.shape[static_cast<std::size_t>(j)];
        A.columns[0] = A.columns[0] + before.x * after;
        A.columns[1] = A.columns[1] + before.y * after;
        A.columns[2] = A.columns[2] + before.z * after;
      }
      const LaneQuaternion old = frames.rotations[v];
      LaneQuaternion fit = old;
      for (int step = 0; step < kSteps; ++step) fit = nearer(A, fit);
      LaneVector own;
      for (std::size_t s = 0; s < shapes.own_fits.size(); ++s) {
        own = own - scaled(reader.shares_of(vertex)[s + 1].value, shapes.own_fits[s][v]);
      }
      fit = fit * lane_rotation_of(own);
      const LaneVector turn = relaxation * lane_rotation_vector(fit * inverse(old));
      frames.rotations[v] = normalised(lane_rotation_of(turn) * old);
    }
  });
}

}  // namespace morphbake
