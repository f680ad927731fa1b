// Blocks of vertices are compared one by one, each at all instants, so that its targets stay in the
// cache: going through all vertices at each instant reads every active target from memory again.
#include "morphbake/diff/motion_difference.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace morphbake {
namespace {

constexpr Eigen::Index kBlock = 1024;      // vertices: 15 targets of a block take 180 kB
constexpr std::size_t kBlocksAtOnce = 32;  // between two looks at the observer
constexpr double kNoDirection = 1e-12;     // squared length of a normal that points nowhere

struct ActiveTarget {
  std::size_t target = 0;
  double weight = 0;

  bool operator==(const ActiveTarget&) const = default;
};

using ActiveTargets = std::vector<ActiveTarget>;

ActiveTargets active_at(const AnimationCurve& curve, double time) {
  const Eigen::VectorXd weights = value_at(curve, time);
  ActiveTargets active;
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    if (weights(k) != 0) active.push_back({static_cast<std::size_t>(k), weights(k)});
  }
  return active;
}

/// Vertices of a primitive that are compared together.
struct Block {
  std::size_t primitive = 0;
  Eigen::Index begin = 0;
  Eigen::Index count = 0;
  Eigen::Index first = 0;  ///< row of `begin` in VertexDifferences
};

using Numbers = Eigen::VectorXf;  // 3 a vertex

/// A block of an attribute of one file, to be posed.
class BlockPose {
 public:
  /// @param base  of the whole primitive
  BlockPose(const Float3s& base, const TargetRows& targets, const Block& block,
            MorphedAttribute attribute)
      : base_(Eigen::Map<const Numbers>(base.data() + 3 * block.begin, 3 * block.count)),
        targets_(targets.count()) {
    Numbers numbers(3 * block.count);
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      const TargetPlace place{block.primitive, k, attribute};
      if (!targets.has(place)) continue;
      targets.read(place, block.begin, block.count, numbers.data());
      if (!numbers.isZero(0)) targets_[k] = numbers;
    }
  }

  bool moves_at_all() const {
    return std::ranges::any_of(targets_, [](const Numbers& target) { return target.size() > 0; });
  }

  /// Base plus weighted targets, mesh space: 3 numbers a vertex.
  void pose(const ActiveTargets& active, Eigen::VectorXd& numbers) const {
    numbers = base_.cast<double>();
    for (const auto& [target, weight] : active) {
      if (targets_[target].size() > 0) numbers += weight * targets_[target].cast<double>();
    }
  }

  /// Whether both have the same numbers, so that equal weights give equal shapes.
  bool is_same_as(const BlockPose& other) const {
    return base_ == other.base_ &&
           std::ranges::equal(targets_, other.targets_, [](const Numbers& a, const Numbers& b) {
             return a.size() == b.size() && a == b;
           });
  }

 private:
  Numbers base_;
  std::vector<Numbers> targets_;  ///< one a target: none where it moves nothing of the block
};

/// What one file plays, prepared for all instants.
struct PlayedFile {
  MorphingMesh morph;
  std::vector<ActiveTargets> active;  ///< one an instant
  Eigen::Matrix3d linear;             ///< to the scene
  Eigen::Vector3d offset;
  Eigen::Matrix3d cofactors;  ///< normals to the scene: the inverse transpose up to a factor
  bool is_sampled = false;    ///< and the other one has other keys
  std::vector<ActiveTargets> frames;  ///< of a sampled file: one a key
  std::vector<int>
      interval;  ///< of a sampled file, one an instant: the frame before, -1 at a frame
};

Eigen::Matrix3d cofactors_of(const Eigen::Matrix3d& linear) {
  const Eigen::Matrix3d unit = linear / std::max(linear.norm(), 1e-300);
  Eigen::Matrix3d cofactors;
  for (int k = 0; k < 3; ++k) cofactors.col(k) = unit.col((k + 1) % 3).cross(unit.col((k + 2) % 3));
  return cofactors;
}

PlayedFile played(const MorphingMesh& morph, const AnimationCurve& curve,
                  const std::vector<double>& times) {
  const Eigen::Matrix4d& to_scene = morph.mesh.to_scene;
  PlayedFile file{morph,
                  {},
                  to_scene.topLeftCorner<3, 3>(),
                  to_scene.topRightCorner<3, 1>(),
                  cofactors_of(to_scene.topLeftCorner<3, 3>()),
                  false,
                  {},
                  {}};
  for (const double time : times) file.active.push_back(active_at(curve, time));
  return file;
}

/// Finds the frames of a sampled file between which each instant lies.
///
/// @param is_key  one an instant: whether it is a frame of this file
void find_intervals(const AnimationCurve& curve, const std::vector<double>& times,
                    const std::vector<bool>& is_key, PlayedFile& file) {
  file.is_sampled = true;
  for (const float key : curve.times) file.frames.push_back(active_at(curve, key));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), times[i],
                                        [](double time, float key) { return time < key; });
    const bool is_between =
        !is_key[i] && after != curve.times.begin() && after != curve.times.end();
    file.interval.push_back(is_between ? static_cast<int>(after - curve.times.begin()) - 1 : -1);
  }
}

/// Half of how far each vertex bends in the frames around an interval, which is what its chord may
/// leave out.
class SamplingSlack {
 public:
  SamplingSlack(const PlayedFile& file, const BlockPose& pose) : file_(file), pose_(pose) {}

  /// Adds the slack of the instant to `slack`, scene units, one a vertex.
  void add(std::size_t instant, Eigen::VectorXd& slack) {
    if (!file_.is_sampled || file_.interval[instant] < 0) return;
    const int interval = file_.interval[instant];
    if (interval != interval_) {
      interval_ = interval;
      slack_ = bend_at(interval).cwiseMax(bend_at(interval + 1)) / 2;
    }
    slack += slack_;
  }

 private:
  /// Length of the second difference at a frame, 0 at the first and the last.
  Eigen::VectorXd bend_at(int frame) const {
    const int last = static_cast<int>(file_.frames.size()) - 1;
    Eigen::VectorXd before, here, after;
    pose_.pose(file_.frames[static_cast<std::size_t>(std::max(frame - 1, 0))], before);
    pose_.pose(file_.frames[static_cast<std::size_t>(frame)], here);
    pose_.pose(file_.frames[static_cast<std::size_t>(std::min(frame + 1, last))], after);
    const Eigen::VectorXd difference = before - 2 * here + after;
    if (frame == 0 || frame == last) return Eigen::VectorXd::Zero(here.size() / 3);
    const Eigen::Map<const Eigen::Matrix3Xd> bends(difference.data(), 3, difference.size() / 3);
    return (file_.linear * bends).colwise().norm();
  }

  const PlayedFile& file_;
  const BlockPose& pose_;
  int interval_ = -1;
  Eigen::VectorXd slack_;
};

/// The largest differences of a block.
struct BlockDifference {
  LargestDifference position;
  LargestDifference normal;  ///< value: see turn_of
};

/// A number that rises with the angle between two vectors, 0 to 2, without a root or an arc: the
/// squared sine, and 2 less that beyond a right angle. A vector without direction is at a right
/// angle to all that have one.
double turn_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double lengths_a = a.squaredNorm(), lengths_b = b.squaredNorm();
  if (lengths_a < kNoDirection || lengths_b < kNoDirection) {
    return lengths_a < kNoDirection && lengths_b < kNoDirection ? 0 : 1;
  }
  const double sine = std::min(a.cross(b).squaredNorm() / (lengths_a * lengths_b), 1.0);
  return a.dot(b) >= 0 ? sine : 2 - sine;
}

double degrees_of(double turn) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  return turn <= 1 ? kDegrees * std::asin(std::sqrt(turn))
                   : 180 - kDegrees * std::asin(std::sqrt(std::max(0.0, 2 - turn)));
}

/// Two files, and all instants.
struct Comparing {
  PlayedFile a;
  PlayedFile b;
  std::vector<double> times;
  bool is_same_place = false;  ///< whether both have one transform

  /// Whether equal bytes give equal places at that instant.
  bool has_equal_weights(std::size_t instant) const {
    return is_same_place && a.active[instant] == b.active[instant];
  }
};

const AnimatedPrimitive& primitive_of(const PlayedFile& file, const Block& block) {
  return file.morph.mesh.primitives[block.primitive];
}

bool has_normals(const PlayedFile& file, const Block& block) {
  return primitive_of(file, block).normals.rows() > 0;
}

BlockPose pose_of(const PlayedFile& file, const Block& block, MorphedAttribute attribute) {
  const AnimatedPrimitive& primitive = primitive_of(file, block);
  const bool is_normal = attribute == MorphedAttribute::Normal;
  return {is_normal ? primitive.normals : primitive.positions, file.morph.targets, block,
          attribute};
}

using Points = Eigen::Map<const Eigen::Matrix3Xd>;

Points points_of(const Eigen::VectorXd& numbers) { return {numbers.data(), 3, numbers.size() / 3}; }

/// Where nothing moves, the first instant tells all.
std::size_t instants_that_differ(const Comparing& comparing, const BlockPose& a,
                                 const BlockPose& b) {
  return a.moves_at_all() || b.moves_at_all() ? comparing.times.size() : 1;
}

/// The first one of the largest.
void keep_larger(const LargestDifference& found, LargestDifference& largest) {
  if (found.value > largest.value) largest = found;
}

LargestDifference difference_at(const Block& block, Eigen::Index v, double value, double time) {
  return {value, time, static_cast<int>(block.primitive), static_cast<int>(block.begin + v), 0};
}

void compare_positions(const Comparing& comparing, const Block& block,
                       Eigen::Ref<Eigen::VectorXd> distances, LargestDifference& largest) {
  const BlockPose a = pose_of(comparing.a, block, MorphedAttribute::Position);
  const BlockPose b = pose_of(comparing.b, block, MorphedAttribute::Position);
  const bool is_same = a.is_same_as(b);
  SamplingSlack slack_a(comparing.a, a), slack_b(comparing.b, b);
  Eigen::VectorXd of_a, of_b, slack(block.count);
  const std::size_t instants = instants_that_differ(comparing, a, b);
  for (std::size_t i = 0; i < instants; ++i) {
    if (is_same && comparing.has_equal_weights(i)) continue;
    a.pose(comparing.a.active[i], of_a);
    b.pose(comparing.b.active[i], of_b);
    slack.setZero();
    slack_a.add(i, slack);
    slack_b.add(i, slack);
    const Points in_a = points_of(of_a), in_b = points_of(of_b);
    const Eigen::Vector3d offset = comparing.a.offset - comparing.b.offset;
    for (Eigen::Index v = 0; v < block.count; ++v) {
      const Eigen::Vector3d apart =
          comparing.a.linear * in_a.col(v) - comparing.b.linear * in_b.col(v) + offset;
      const double length = apart.norm();
      // Beyond what a double can hold; NaN would be smaller than anything.
      const double distance = std::isfinite(length) ? length : std::numeric_limits<double>::max();
      const double beyond = distance - slack(v);
      if (beyond <= distances(v)) continue;
      distances(v) = beyond;
      LargestDifference found = difference_at(block, v, beyond, comparing.times[i]);
      found.sampling = slack(v);
      keep_larger(found, largest);
    }
  }
}

/// @param turns  see turn_of
void compare_normals(const Comparing& comparing, const Block& block,
                     Eigen::Ref<Eigen::VectorXd> turns, LargestDifference& largest) {
  if (!has_normals(comparing.a, block) || !has_normals(comparing.b, block)) return;
  const BlockPose a = pose_of(comparing.a, block, MorphedAttribute::Normal);
  const BlockPose b = pose_of(comparing.b, block, MorphedAttribute::Normal);
  const bool is_same = a.is_same_as(b);
  Eigen::VectorXd of_a, of_b;
  const std::size_t instants = instants_that_differ(comparing, a, b);
  for (std::size_t i = 0; i < instants; ++i) {
    if (is_same && comparing.has_equal_weights(i)) continue;
    a.pose(comparing.a.active[i], of_a);
    b.pose(comparing.b.active[i], of_b);
    const Points normals_a = points_of(of_a), normals_b = points_of(of_b);
    for (Eigen::Index v = 0; v < block.count; ++v) {
      const double turn = comparing.is_same_place && comparing.a.linear.isIdentity(0)
                              ? turn_of(normals_a.col(v), normals_b.col(v))
                              : turn_of(comparing.a.cofactors * normals_a.col(v),
                                        comparing.b.cofactors * normals_b.col(v));
      if (turn <= turns(v)) continue;
      turns(v) = turn;
      keep_larger(difference_at(block, v, turn, comparing.times[i]), largest);
    }
  }
}

std::vector<Block> blocks_of(const MeshPair& meshes) {
  std::vector<Block> blocks;
  Eigen::Index first = 0;
  for (const std::size_t primitive : meshes.primitives) {
    const Eigen::Index rows = meshes.a.mesh.primitives[primitive].positions.rows();
    for (Eigen::Index begin = 0; begin < rows; begin += kBlock) {
      blocks.push_back({primitive, begin, std::min(kBlock, rows - begin), first + begin});
    }
    first += rows;
  }
  return blocks;
}

Comparing prepare(const MeshPair& meshes, const CurvePair& curves, const MotionOptions& options) {
  std::array<std::vector<double>, 2> times;
  std::array<std::vector<bool>, 2> is_key;
  for (const Instant& instant : common_instants(curves)) {
    times[0].push_back(instant.time_a);
    times[1].push_back(instant.time_b);
    is_key[0].push_back(instant.is_key_a);
    is_key[1].push_back(instant.is_key_b);
  }
  Comparing comparing{played(meshes.a, curves.a, times[0]), played(meshes.b, curves.b, times[1]),
                      times[0], meshes.a.mesh.to_scene == meshes.b.mesh.to_scene};
  if (!options.allows_sampling || have_same_keys(curves)) return comparing;
  if (is_sampled(curves.a)) find_intervals(curves.a, times[0], is_key[0], comparing.a);
  if (is_sampled(curves.b)) find_intervals(curves.b, times[1], is_key[1], comparing.b);
  return comparing;
}

}  // namespace

MotionDifference compare_motions(const MeshPair& meshes, const CurvePair& curves,
                                 const MotionOptions& options, VertexDifferences& vertices,
                                 const Observer& observer) {
  const Comparing comparing = prepare(meshes, curves, options);
  const std::vector<Block> blocks = blocks_of(meshes);
  VertexDifferences here = no_differences(meshes);
  std::vector<BlockDifference> found(blocks.size());
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);
  for (std::size_t begin = 0; begin < blocks.size(); begin += kBlocksAtOnce) {
    advance(observer, {"compare", static_cast<int>(begin), static_cast<int>(blocks.size())});
    const std::size_t end = std::min(begin + kBlocksAtOnce, blocks.size());
    arena.execute([&] {
      tbb::parallel_for(begin, end, [&](std::size_t i) {
        stop_if_cancelled(observer);
        const Block& block = blocks[i];
        compare_positions(comparing, block, here.distance.segment(block.first, block.count),
                          found[i].position);
        compare_normals(comparing, block, here.normal_angle.segment(block.first, block.count),
                        found[i].normal);
      });
    });
  }
  MotionDifference difference;
  difference.instants = comparing.times.size();
  for (const BlockDifference& block : found) {
    keep_larger(block.position, difference.position);
    keep_larger(block.normal, difference.normal);
  }
  difference.normal.value = degrees_of(difference.normal.value);
  vertices.distance = vertices.distance.cwiseMax(here.distance);
  vertices.normal_angle = vertices.normal_angle.cwiseMax(here.normal_angle.unaryExpr(&degrees_of));
  return difference;
}

VertexDifferences no_differences(const MeshPair& meshes) {
  Eigen::Index rows = 0;
  for (const std::size_t p : meshes.primitives)
    rows += meshes.a.mesh.primitives[p].positions.rows();
  return {Eigen::VectorXd::Zero(rows), Eigen::VectorXd::Zero(rows)};
}

}  // namespace morphbake
