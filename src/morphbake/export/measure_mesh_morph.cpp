#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "morphbake/export/mesh_morph.h"
#include "morphbake/gltf/morphed_rows.h"

namespace morphbake {
namespace {

constexpr int kBinsPerDegree = 100;
constexpr std::size_t kMomentsAtOnce = 8;  // in memory, whatever the number of threads

/// Angle in degrees; atan2 keeps its digits where acos loses them.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

/// How many angles fall into each hundredth of a degree.
struct AngleHistogram {
  std::vector<std::uint64_t> counts = std::vector<std::uint64_t>(180 * kBinsPerDegree + 1, 0);

  void add(double angle) { ++counts[static_cast<std::size_t>(angle * kBinsPerDegree)]; }

  void add(const AngleHistogram& other) {
    for (std::size_t bin = 0; bin < counts.size(); ++bin) counts[bin] += other.counts[bin];
  }

  /// Upper end of the bin below which `share` of all angles lie.
  double percentile(double share) const {
    std::uint64_t total = 0;
    for (const std::uint64_t count : counts) total += count;
    std::uint64_t below = 0;
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
      below += counts[bin];
      if (static_cast<double>(below) >= share * static_cast<double>(total)) {
        return static_cast<double>(bin + 1) / kBinsPerDegree;
      }
    }
    return 0;
  }
};

std::vector<double> frames_and_middles(const std::vector<double>& frame_times) {
  std::vector<double> times;
  for (std::size_t f = 0; f < frame_times.size(); ++f) {
    if (f > 0) times.push_back((frame_times[f - 1] + frame_times[f]) / 2);
    times.push_back(frame_times[f]);
  }
  return times;
}

/// What is compared; the same at all moments.
struct Comparison {
  const MorphableMesh& mesh;
  const AnimatedMesh& written;
  const SmoothingGroups& groups;
};

struct MomentError {
  MorphError error;
  AngleHistogram angles;
};

MomentError measure_moment(const Comparison& compared, const Positions& expected, double time) {
  const AnimatedMesh& written = compared.written;
  const SmoothingGroups& groups = compared.groups;
  const Eigen::Matrix4d& to_scene = written.to_scene;
  const Eigen::Matrix3d linear = to_scene.topLeftCorner<3, 3>();
  const Eigen::RowVector3d translation = to_scene.topRightCorner<3, 1>().transpose();
  const Eigen::Matrix3d inverse = linear.inverse();
  const Eigen::VectorXd w = weights_at(written, time);
  Normals expected_normals;
  if (groups.count > 0) expected_normals = deformed_normals(groups, compared.mesh, expected);
  MomentError moment;
  MorphError& error = moment.error;
  error.distance_time = error.normal_time = time;
  const auto add_angle = [&](double angle, std::size_t render) {
    moment.angles.add(angle);
    if (angle <= error.normal_angle) return;
    error.normal_angle = angle;
    error.normal_vertex = static_cast<int>(render);
  };
  std::size_t render = 0;
  for (const AnimatedPrimitive& primitive : written.primitives) {
    const Positions positions = morphed_rows(primitive.positions, primitive.target_positions, w);
    Positions normals;
    if (groups.count > 0) normals = morphed_rows(primitive.normals, primitive.target_normals, w);
    for (Eigen::Index r = 0; r < positions.rows(); ++r, ++render) {
      const int vertex = compared.mesh.vertex_of_render[render];
      if (vertex < 0) continue;
      const Eigen::RowVector3d at = positions.row(r) * linear.transpose() + translation;
      const double distance = (at - expected.row(vertex)).norm();
      if (distance > error.distance) {
        error.distance = distance;
        error.distance_vertex = static_cast<int>(render);
      }
      if (groups.count == 0) continue;
      const Eigen::Vector3d normal = (normals.row(r) * inverse).transpose();
      add_angle(angle_between(normal, expected_normals.row(groups.of_render[render])), render);
    }
  }
  return moment;
}

}  // namespace

MorphError measure_mesh_morph(const MorphableMesh& mesh, const AnimatedMesh& written,
                              const SmoothingGroups& groups, const ReferenceMotion& motion) {
  const Comparison compared{mesh, written, groups};
  const std::vector<double> times = frames_and_middles(motion.frame_times);
  MorphError worst;
  AngleHistogram angles;
  for (std::size_t begin = 0; begin < times.size(); begin += kMomentsAtOnce) {
    const std::size_t count = std::min(kMomentsAtOnce, times.size() - begin);
    // Frames are pulled in order by one thread; only the measuring is spread.
    std::vector<Positions> expected(count);
    for (std::size_t i = 0; i < count; ++i) expected[i] = motion.positions_at(times[begin + i]);
    std::vector<MomentError> moments(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      moments[i] = measure_moment(compared, expected[i], times[begin + i]);
    });
    for (const MomentError& moment : moments) {
      if (moment.error.distance > worst.distance) {
        worst.distance = moment.error.distance;
        worst.distance_time = moment.error.distance_time;
        worst.distance_vertex = moment.error.distance_vertex;
      }
      angles.add(moment.angles);
      if (moment.error.normal_angle <= worst.normal_angle) continue;
      worst.normal_angle = moment.error.normal_angle;
      worst.normal_time = moment.error.normal_time;
      worst.normal_vertex = moment.error.normal_vertex;
    }
  }
  worst.normal_angle_99 = std::min(angles.percentile(0.99), worst.normal_angle);
  return worst;
}

}  // namespace morphbake
