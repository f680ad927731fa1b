#include "morphbake/landmarks/correspondences.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/normals.h"

namespace morphbake {
namespace {

constexpr double kPlaceWeight = 1;
constexpr double kFacingWeight = 0.03;
constexpr double kDistanceLimit = 0.3;  // of the squares of differences, as in alignments
constexpr double kNear = 0.2;           // in `reach`: how near a landmark must be to count most
constexpr double kApart = 0.2;          // in `reach`: least distance between landmarks
constexpr double kTipsApart = 0.12;     // likewise, of tips that only one shape has
constexpr double kOnPlane = 0.1;        // in `reach`: from a vertex on the plane to that across
constexpr double kOfTip = 0.15;         // in `reach`: what belongs to a tip
constexpr double kOffPlane = 0.06;      // of the diagonal: nearer to the mirror plane is on it

}  // namespace

Side::Side(const ShapeSketch& shape)
    : sketch(shape),
      symmetry(find_symmetry(shape)),
      distances(shape.mesh),
      normals(smooth_normals(shape.mesh.positions, shape.mesh.triangles)) {}

double Side::to_landmark(int vertex) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::VectorXd& distance : from_landmark) {
    nearest = std::min(nearest, distance(vertex));
  }
  return nearest;
}

int Side::twin(int vertex) const {
  const double diagonal = bounding_diagonal(sketch.mesh.positions);
  const bool is_off = std::abs(symmetry.side_of(position(vertex))) > kOffPlane * diagonal;
  return symmetry.is_exact && is_off ? across(vertex) : -1;
}

int Side::across(int vertex) const {
  const Eigen::RowVector3d image = symmetry.across(position(vertex)).transpose();
  int closest = 0;
  (sketch.mesh.positions.rowwise() - image).rowwise().squaredNorm().minCoeff(&closest);
  return closest;
}

void add_pair(Correspondences& all, int a, int b, PairKind kind, bool mirrors_last) {
  if (!mirrors_last) ++all.units;
  all.pairs.push_back({a, b, kind, all.units});
  all.a.from_landmark.push_back(all.a.distances.from(a) / all.a.sketch.reach);
  all.b.from_landmark.push_back(all.b.distances.from(b) / all.b.sketch.reach);
}

std::optional<int> transferred(const Side& from, const Side& to, int vertex, PairKind kind,
                               Lies lies) {
  const Eigen::Vector3d place = from.frame.in_box(from.position(vertex));
  const Eigen::Vector3d facing = from.frame.axes.transpose() * from.normals.row(vertex).transpose();
  Eigen::VectorXd cost(to.sketch.mesh.positions.rows());
  for (int v = 0; v < cost.size(); ++v) {
    const Eigen::Vector3d other = to.frame.axes.transpose() * to.normals.row(v).transpose();
    const double apart = (to.frame.in_box(to.position(v)) - place).squaredNorm();
    cost(v) = kPlaceWeight * apart / (1 + apart) + kFacingWeight * (1 - facing.dot(other));
  }
  double weights = 0;
  Eigen::VectorXd differences = Eigen::VectorXd::Zero(cost.size());
  for (std::size_t k = 0; k < from.from_landmark.size(); ++k) {
    const double distance = from.from_landmark[k](vertex);
    const double weight = 1 / ((kNear + distance) * (kNear + distance));
    differences.array() +=
        weight * (to.from_landmark[k].array() - distance).square().min(kDistanceLimit);
    weights += weight;
  }
  if (weights > 0) cost += differences / weights;
  if (kind == PairKind::Tip) {
    // What grows nowhere on the other shape is none of its tips.
    for (const Eigen::VectorXd& distance : to.sketch.from_tip) {
      cost = (distance.array() < kOfTip).select(cost.array() + 1, cost.array());
    }
  }
  // Far points are not missed where a landmark is near; tips are, and move aside.
  int best = 0;
  if (kind != PairKind::Tip) {
    cost.minCoeff(&best);
    return to.to_landmark(best) < kApart ? std::nullopt : std::optional<int>(best);
  }
  for (int v = 0; v < cost.size(); ++v) {
    const double across = 2 * std::abs(to.symmetry.side_of(to.position(v))) / to.sketch.reach;
    const bool is_wrong = (lies == Lies::OffPlane && across < kTipsApart) ||
                          (lies == Lies::OnPlane && across > kOnPlane);
    const bool is_taken = to.to_landmark(v) < kTipsApart || (to.symmetry.is_exact && is_wrong);
    if (is_taken) cost(v) = std::numeric_limits<double>::infinity();
  }
  return std::isfinite(cost.minCoeff(&best)) ? std::optional<int>(best) : std::nullopt;
}

int add_transferred(Correspondences& all, const Transfer& transfer, int most) {
  const bool on_a = transfer.on_a;
  const Side& from = on_a ? all.a : all.b;
  const Side& to = on_a ? all.b : all.a;
  const int needed = transfer.twin < 0 ? 1 : 2;
  if (most < needed) return 0;
  const double apart = transfer.kind == PairKind::Tip ? kTipsApart : kApart;
  const Lies lies = transfer.twin >= 0   ? Lies::OffPlane
                    : transfer.is_middle ? Lies::OnPlane
                                         : Lies::Anywhere;
  const auto add = [&](int here, int base, bool mirrors_last) {
    if (from.to_landmark(here) < kApart) return false;
    std::optional<int> there;
    // The other shape's own symmetry is more exact than two searches.
    if (mirrors_last && to.symmetry.is_exact) {
      there = to.across(on_a ? all.pairs.back().b : all.pairs.back().a);
      if (to.to_landmark(*there) < apart) there.reset();
    } else {
      there = transferred(from, to, base, transfer.kind, mirrors_last ? Lies::Anywhere : lies);
    }
    if (!there) return false;
    add_pair(all, on_a ? here : *there, on_a ? *there : here, transfer.kind, mirrors_last);
    return true;
  };
  if (!add(transfer.vertex, transfer.base, false)) return 0;
  if (transfer.twin < 0) return 1;
  if (add(transfer.twin, transfer.twin_base, true)) return 2;
  // One ear of two would make the other shape lopsided.
  if (transfer.kind != PairKind::Tip) return 1;
  all.pairs.pop_back();
  all.a.from_landmark.pop_back();
  all.b.from_landmark.pop_back();
  return 0;
}

}  // namespace morphbake
