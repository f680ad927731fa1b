#include "morphbake/transition/region_fields.h"

#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "morphbake/transition/spatial.h"

namespace morphbake {
namespace {

/// d where the front has come by `amount`: it starts with nothing inside and ends with all.
Eigen::VectorXd flood_distance(const FloodField& flood, double amount) {
  if (flood.softness == 0) {
    return (flood.order.array() >= amount).cast<double>();
  }
  const double front = amount * (1 + flood.softness);
  return 1 - ((front - flood.order.array()) / flood.softness).max(0).min(1);
}

/// The regions of one moment. Each combination is evaluated once: many others may be made of it.
class Evaluation {
 public:
  Evaluation(const RegionFields& fields, const RegionMoment& moment)
      : fields_(fields), moment_(moment) {}

  const Eigen::VectorXd& distance(int region) {
    const RegionField& field = fields_[static_cast<std::size_t>(region)];
    if (const auto* fixed = std::get_if<Eigen::VectorXd>(&field.form)) return *fixed;
    const auto known = known_.find(region);
    if (known != known_.end()) return known->second;
    Eigen::VectorXd d;
    if (const auto* spatial = std::get_if<SpatialField>(&field.form)) {
      d = spatial_distance(*spatial, moment_.time);
    } else if (const auto* flood = std::get_if<FloodField>(&field.form)) {
      d = flood_distance(*flood, moment_.amount);
    } else {
      d = combined(std::get<CombinedRegion>(field.form));
    }
    return known_[region] = bent_by(field.falloff, std::move(d));
  }

 private:
  Eigen::VectorXd combined(const CombinedRegion& combined);

  const RegionFields& fields_;
  const RegionMoment& moment_;
  std::map<int, Eigen::VectorXd> known_;
};

Eigen::VectorXd Evaluation::combined(const CombinedRegion& combined) {
  using Kind = CombinedRegion::Kind;
  Eigen::VectorXd d = distance(combined.regions.front());
  for (std::size_t i = 1; i < combined.regions.size(); ++i) {
    const Eigen::VectorXd& other = distance(combined.regions[i]);
    switch (combined.kind) {
      case Kind::Union:
      case Kind::RestOf:
        d = d.cwiseMin(other);
        break;
      case Kind::Intersection:
        d = d.cwiseMax(other);
        break;
      case Kind::Difference:
        d = d.array().max(1 - other.array());
        break;
    }
  }
  if (combined.kind == Kind::RestOf) d = 1 - d.array();
  return d;
}

}  // namespace

Eigen::VectorXd bent_by(Falloff falloff, Eigen::VectorXd d) {
  switch (falloff) {
    case Falloff::Linear:
      break;
    case Falloff::Smoothstep:
      d = d.array().square() * (3 - 2 * d.array());
      break;
    case Falloff::Cosine:
      d = (1 - (M_PI * d.array()).cos()) / 2;
      break;
  }
  return d;
}

RegionFields fixed_fields(std::vector<Eigen::VectorXd> distances) {
  RegionFields fields;
  for (Eigen::VectorXd& d : distances) fields.push_back({std::move(d)});
  return fields;
}

Eigen::VectorXd distance_at(const RegionFields& fields, int region, const RegionMoment& moment) {
  return Evaluation(fields, moment).distance(region);
}

const Eigen::VectorXd& fixed_distance(const RegionFields& fields, int region) {
  const auto* fixed = std::get_if<Eigen::VectorXd>(&fields[static_cast<std::size_t>(region)].form);
  assert(fixed != nullptr);
  return *fixed;
}

}  // namespace morphbake
