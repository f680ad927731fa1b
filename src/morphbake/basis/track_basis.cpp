#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "morphbake/basis/morph_basis.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

// glTF target names beyond this length are cut by engines.
constexpr std::size_t kNameLimit = 63;

struct WeightKey {
  float time;
  Eigen::VectorXd weights;  ///< one a target
};

/// What keys the weight curves: how far each target moves the surface, and how much of that may be
/// lost.
struct CurveTolerance {
  Eigen::VectorXd reach;  ///< largest displacement of each target, scene units
  double distance;        ///< scene units
};

class WeightCurves {
 public:
  WeightCurves(const SeparableTimeline& separable, const Timeline& timeline,
               CurveTolerance tolerance)
      : separable_(separable), timeline_(timeline), tolerance_(std::move(tolerance)) {}

  /// Keys of a part of the timeline, with times from its beginning on.
  std::vector<WeightKey> keys(const Clip& clip) {
    begin_ = clip.begin;
    keys_.clear();
    keys_.push_back(key_at(0));
    for (const double time : breaks_in(clip)) {
      const auto end = static_cast<float>(time - begin_);
      if (end <= keys_.back().time) continue;
      // A jump at the break needs two keys: the last number before it still has the old weights.
      const WeightKey after = key_at_moment(time);
      WeightKey before{end, weights_before(time)};
      const bool jumps = moved(before.weights - after.weights) > tolerance_.distance;
      if (jumps) before.time = std::nextafter(end, -std::numeric_limits<float>::infinity());
      refine(keys_.back(), before, 0);
      if (jumps && before.time > keys_.back().time) keys_.push_back(before);
      keys_.push_back(after);
    }
    return std::move(keys_);
  }

 private:
  Eigen::VectorXd weights_before(double time) const {
    return field_coefficients_before(timeline_, separable_, time).tail(tolerance_.reach.size());
  }

  /// Breaks of the timeline inside of a clip, and its end.
  std::vector<double> breaks_in(const Clip& clip) const {
    std::vector<double> breaks = timeline_breaks(timeline_);
    std::erase_if(breaks, [&](double time) { return time <= clip.begin || time >= clip.end; });
    breaks.push_back(clip.end);
    return breaks;
  }

  WeightKey key_at_moment(double time) const {
    return {static_cast<float>(time - begin_),
            field_coefficients(timeline_, separable_, time).tail(tolerance_.reach.size())};
  }

  /// @param time  from the beginning of the clip on
  WeightKey key_at(double time) const { return key_at_moment(begin_ + time); }

  /// A bound on how far a vertex moves when the weights change by `difference`.
  double moved(const Eigen::VectorXd& difference) const {
    return difference.cwiseAbs().dot(tolerance_.reach);
  }

  bool is_linear_between(const WeightKey& from, const WeightKey& to) const {
    for (const double share : {0.25, 0.5, 0.75}) {
      const double time = (1 - share) * from.time + share * to.time;
      const Eigen::VectorXd chord = (1 - share) * from.weights + share * to.weights;
      if (moved(key_at(time).weights - chord) > tolerance_.distance) return false;
    }
    return true;
  }

  /// Appends the keys strictly between `from` and `to`.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): a reference into keys_ would dangle
  void refine(const WeightKey from, const WeightKey& to, int depth) {
    constexpr int kDepthLimit = 16;
    const float middle = from.time + (to.time - from.time) / 2;
    const bool is_splittable = from.time < middle && middle < to.time;
    if (depth == kDepthLimit || !is_splittable || is_linear_between(from, to)) return;
    const WeightKey key = key_at(middle);
    refine(from, key, depth + 1);
    keys_.push_back(key);
    refine(key, to, depth + 1);
  }

  const SeparableTimeline& separable_;
  const Timeline& timeline_;
  CurveTolerance tolerance_;
  double begin_ = 0;  // of the clip
  std::vector<WeightKey> keys_;
};

std::string cut_name(const std::string& name, std::size_t limit) {
  std::size_t end = std::min(name.size(), limit);
  // Never inside a UTF-8 character.
  while (end > 0 && end < name.size() && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80)
    --end;
  return name.substr(0, end);
}

std::string unique_name(const std::string& wished, std::set<std::string>& taken) {
  std::string name = cut_name(wished, kNameLimit);
  for (int n = 2; !taken.insert(name).second; ++n) {
    const std::string suffix = fmt::format("~{}", n);
    name = cut_name(wished, kNameLimit - suffix.size()) + suffix;
  }
  return name;
}

void add_clip(MorphBasis& basis, const std::vector<WeightKey>& keys) {
  WeightKeys clip;
  clip.weights.resize(static_cast<Eigen::Index>(keys.size()),
                      static_cast<Eigen::Index>(basis.targets.size()));
  for (std::size_t k = 0; k < keys.size(); ++k) {
    clip.times.push_back(keys[k].time);
    clip.weights.row(static_cast<Eigen::Index>(k)) =
        keys[k].weights.cast<float>().cwiseMax(0.0F).cwiseMin(1.0F).transpose();
  }
  basis.clips.push_back(std::move(clip));
}

double largest_row(const Positions& rows) {
  return rows.rows() == 0 ? 0 : std::sqrt(rows.rowwise().squaredNorm().maxCoeff());
}

}  // namespace

MorphBasis track_basis(const SolvedShapes& shapes, const SeparableTimeline& separable,
                       const Timeline& timeline, const std::vector<Clip>& clips,
                       const BasisOptions& options) {
  MorphBasis basis;
  basis.base = shapes.base;
  std::set<std::string> taken;
  CurveTolerance tolerance{Eigen::VectorXd(static_cast<Eigen::Index>(shapes.displacements.size())),
                           options.easing_tolerance * bounding_diagonal(shapes.base)};
  for (std::size_t k = 0; k < shapes.displacements.size(); ++k) {
    basis.targets.push_back({unique_name(shapes.names[k], taken), shapes.displacements[k]});
    tolerance.reach(static_cast<Eigen::Index>(k)) = largest_row(shapes.displacements[k]);
  }
  WeightCurves curves(separable, timeline, std::move(tolerance));
  for (const Clip& clip : clips) add_clip(basis, curves.keys(clip));
  return basis;
}

}  // namespace morphbake
