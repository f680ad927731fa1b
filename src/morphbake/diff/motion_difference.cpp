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
#include <cstring>
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

/// One attribute of one file in a primitive.
struct MorphedAttribute {
  const Float3s& base;
  const std::vector<Float3s>& targets;
};

/// Vertices of a primitive that are compared together.
struct Block {
  std::size_t primitive = 0;
  Eigen::Index begin = 0;
  Eigen::Index count = 0;
  Eigen::Index first = 0;  ///< row of `begin` in VertexDifferences
};

const float* numbers_of(const Float3s& rows, const Block& block) {
  return rows.data() + 3 * block.begin;
}

/// Which targets move a vertex of the block at all.
std::vector<bool> moving_targets(const MorphedAttribute& attribute, const Block& block) {
  std::vector<bool> moves;
  for (const Float3s& target : attribute.targets) {
    const bool has_rows = target.rows() > 0;
    const float* first = has_rows ? numbers_of(target, block) : nullptr;
    moves.push_back(has_rows && std::any_of(first, first + 3 * block.count,
                                            [](float number) { return number != 0; }));
  }
  return moves;
}

/// A block of an attribute of one file, to be posed.
class BlockPose {
 public:
  BlockPose(const MorphedAttribute& attribute, const Block& block)
      : attribute_(attribute), block_(block), moves_(moving_targets(attribute, block)) {}

  bool moves_at_all() const {
    return std::find(moves_.begin(), moves_.end(), true) != moves_.end();
  }

  /// Base plus weighted targets, mesh space: 3 numbers a vertex.
  void pose(const ActiveTargets& active, Eigen::VectorXd& numbers) const {
    using Numbers = Eigen::Map<const Eigen::VectorXf>;
    const Eigen::Index size = 3 * block_.count;
    numbers = Numbers(numbers_of(attribute_.base, block_), size).cast<double>();
    for (const auto& [target, weight] : active) {
      if (target >= moves_.size() || !moves_[target]) continue;
      const float* displacement = numbers_of(attribute_.targets[target], block_);
      numbers += weight * Numbers(displacement, size).cast<double>();
    }
  }

  /// Whether both have the same bytes, so that equal weights give equal numbers.
  bool is_same_as(const BlockPose& other) const {
    if (moves_ != other.moves_) return false;
    if (!same_bytes(attribute_.base, other.attribute_.base)) return false;
    for (std::size_t k = 0; k < moves_.size(); ++k) {
      if (moves_[k] && !same_bytes(attribute_.targets[k], other.attribute_.targets[k]))
        return false;
    }
    return true;
  }

 private:
  bool same_bytes(const Float3s& a, const Float3s& b) const {
    const std::size_t bytes = 3 * sizeof(float) * static_cast<std::size_t>(block_.count);
    return std::memcmp(numbers_of(a, block_), numbers_of(b, block_), bytes) == 0;
  }

  MorphedAttribute attribute_;
  Block block_;
  std::vector<bool> moves_;  ///< one a target
};

/// What one file plays, prepared for all instants.
struct PlayedFile {
  const AnimatedMesh& mesh;
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

PlayedFile played(const AnimatedMesh& mesh, const AnimationCurve& curve,
                  const std::vector<double>& times) {
  PlayedFile file{mesh,
                  {},
                  mesh.to_scene.topLeftCorner<3, 3>(),
                  mesh.to_scene.topRightCorner<3, 1>(),
                  cofactors_of(mesh.to_scene.topLeftCorner<3, 3>()),
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

MorphedAttribute positions_of(const AnimatedPrimitive& primitive) {
  return {primitive.positions, primitive.target_positions};
}

MorphedAttribute normals_of(const AnimatedPrimitive& primitive) {
  return {primitive.normals, primitive.target_normals};
}

using Points = Eigen::Map<const Eigen::Matrix3Xd>;

Points points_of(const Eigen::VectorXd& numbers) { return {numbers.data(), 3, numbers.size() / 3}; }

/// Where nothing moves, the first instant tells all.
std::size_t instants_that_differ(const Comparing& comparing, const BlockPose& a,
                                 const BlockPose& b) {
  return a.moves_at_all() || b.moves_at_all() ? comparing.times.size() : 1;
}

void keep_larger(double value, double sampling, const Block& block, Eigen::Index v, double time,
                 LargestDifference& largest) {
  if (value <= largest.value) return;
  largest = {value, time, static_cast<int>(block.primitive), static_cast<int>(block.begin + v),
             sampling};
}

void compare_positions(const Comparing& comparing, const Block& block,
                       Eigen::Ref<Eigen::VectorXd> distances, LargestDifference& largest) {
  const BlockPose a(positions_of(comparing.a.mesh.primitives[block.primitive]), block);
  const BlockPose b(positions_of(comparing.b.mesh.primitives[block.primitive]), block);
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
      keep_larger(beyond, slack(v), block, v, comparing.times[i], largest);
    }
  }
}

/// @param turns  see turn_of
void compare_normals(const Comparing& comparing, const Block& block,
                     Eigen::Ref<Eigen::VectorXd> turns, LargestDifference& largest) {
  const AnimatedPrimitive& in_a = comparing.a.mesh.primitives[block.primitive];
  const AnimatedPrimitive& in_b = comparing.b.mesh.primitives[block.primitive];
  if (in_a.normals.rows() == 0 || in_b.normals.rows() == 0) return;
  const BlockPose a(normals_of(in_a), block), b(normals_of(in_b), block);
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
      keep_larger(turn, 0, block, v, comparing.times[i], largest);
    }
  }
}

std::vector<Block> blocks_of(const MeshPair& meshes) {
  std::vector<Block> blocks;
  Eigen::Index first = 0;
  for (const std::size_t primitive : meshes.primitives) {
    const Eigen::Index rows = meshes.a.primitives[primitive].positions.rows();
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
                      times[0], meshes.a.to_scene == meshes.b.to_scene};
  if (!options.allows_sampling || have_same_keys(curves)) return comparing;
  if (is_sampled(curves.a)) find_intervals(curves.a, times[0], is_key[0], comparing.a);
  if (is_sampled(curves.b)) find_intervals(curves.b, times[1], is_key[1], comparing.b);
  return comparing;
}

/// The first one of the largest, whatever thread found them.
void keep_larger(const LargestDifference& found, LargestDifference& largest) {
  if (found.value > largest.value) largest = found;
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
  for (const std::size_t p : meshes.primitives) rows += meshes.a.primitives[p].positions.rows();
  return {Eigen::VectorXd::Zero(rows), Eigen::VectorXd::Zero(rows)};
}

}  // namespace morphbake
