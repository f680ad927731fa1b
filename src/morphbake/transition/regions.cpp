#include "morphbake/transition/regions.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/json.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/surface_point.h"
#include "morphbake/transition/rings.h"
#include "morphbake/transition/spatial.h"
#include "morphbake/transition/spread.h"
#include "morphbake/transition/surface_distance.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {
namespace {

/// d = (r - inner) / (outer - inner) within [0, 1]; a step at the radius when both are equal.
Eigen::VectorXd soft_step(const Eigen::VectorXd& r, double inner, double outer) {
  if (outer > inner) return ((r.array() - inner) / (outer - inner)).max(0).min(1);
  return (r.array() > inner).cast<double>();
}

/// The region's pointer, of the field `kind`.
Location location_of(const Recipe& recipe, std::size_t region, const std::string& kind) {
  const std::string& name = recipe.regions[region].name;
  return location_in(recipe, child_pointer("/regions", name) + "/" + kind);
}

/// Where a ball or a flood starts.
struct StartingPoints {
  PointSet from;
  std::size_t index = 0;  ///< among its source's sets, of geodesics
};

/// What the regions of a recipe need from one source's surface.
struct Surveyed {
  Mesh mesh;
  double unit = 1;                             ///< scene units of 1 in the recipe's
  std::vector<PointSet> sets;                  ///< geodesics start at, of all regions
  Location first_asked_at;                     ///< the first region that asks for geodesics
  std::optional<GeodesicDistances> geodesics;  ///< all regions share the factorisation
};

class RegionBuilder {
 public:
  RegionBuilder(const MorphableMesh& mesh, const Recipe& recipe,
                const std::vector<Eigen::VectorXd>& masks,
                std::vector<std::optional<RegionField>> known)
      : mesh_(mesh),
        recipe_(recipe),
        masks_(masks),
        known_(std::move(known)),
        sets_(recipe.regions.size()) {
    known_.resize(recipe.regions.size());
  }

  RegionFields build() {
    for (std::size_t r = 0; r < sets_.size(); ++r) {
      if (!known_[r]) ask(r);
    }
    for (auto& [source, surveyed] : surveyed_) {
      if (surveyed.first_asked_at.pointer.empty()) continue;
      surveyed.geodesics.emplace(surveyed.mesh, surveyed.sets, surveyed.first_asked_at);
    }
    RegionFields fields(sets_.size());
    for (std::size_t r = 0; r < sets_.size(); ++r) {
      fields[r] = known_[r] ? std::move(*known_[r]) : field_of(r);
    }
    std::vector<bool> done(fields.size(), false);
    for (std::size_t r = 0; r < fields.size(); ++r) settle_combination(fields, done, r);
    return fields;
  }

 private:
  Surveyed& survey(int source) {
    const auto [entry, is_new] = surveyed_.try_emplace(source);
    if (is_new) {
      Surveyed& made = entry->second;
      made.mesh = {mesh_.geometries[static_cast<std::size_t>(source)],
                   mesh_.connectivity.triangles};
      made.unit = recipe_.units == Units::Scene ? 1 : bounding_diagonal(made.mesh.positions);
    }
    return entry->second;
  }

  PointSet points(int source, const std::vector<Place>& places) {
    Positions wanted(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i) {
      wanted.row(static_cast<Eigen::Index>(i)) = std::get<Eigen::Vector3d>(places[i]).transpose();
    }
    return closest_points(survey(source).mesh, wanted);
  }

  /// Says from which points a region measures geodesics, before any are measured.
  void ask(std::size_t region) {
    const auto& shape = recipe_.regions[region].shape;
    if (const auto* ball = std::get_if<BallRegion>(&shape)) {
      ask_from(region, ball->source, {ball->centre}, ball->distance);
    } else if (const auto* flood = std::get_if<FloodRegion>(&shape)) {
      ask_from(region, flood->source, flood->seeds, flood->distance);
    } else if (const auto* rings = std::get_if<RingsRegion>(&shape)) {
      ask_from(region, rings->source, {}, rings->distance);  // they start at vertices
    }
  }

  void ask_from(std::size_t region, int source, const std::vector<Place>& places,
                DistanceMeasure measure) {
    Surveyed& surveyed = survey(source);
    sets_[region].from = points(source, places);
    if (measure != DistanceMeasure::Geodesic) return;
    if (surveyed.first_asked_at.pointer.empty()) {
      surveyed.first_asked_at =
          location_in(recipe_, child_pointer("/regions", recipe_.regions[region].name));
    }
    if (places.empty()) return;
    sets_[region].index = surveyed.sets.size();
    surveyed.sets.push_back(sets_[region].from);
  }

  /// Distances of a ball or a flood from where it starts.
  Eigen::VectorXd distances(std::size_t region, int source, DistanceMeasure measure) {
    Surveyed& surveyed = survey(source);
    const auto& [from, index] = sets_[region];
    if (measure == DistanceMeasure::Geodesic) return surveyed.geodesics->from_set(index);
    if (measure == DistanceMeasure::Edges) return edge_distances(surveyed.mesh, from);
    std::vector<int> vertices;
    for (const SurfacePoint& at : from) vertices.push_back(nearest_corner(surveyed.mesh, at));
    return hop_distances(surveyed.mesh, vertices);
  }

  /// Distances of rings from one of their loops.
  static Eigen::VectorXd distances_from(Surveyed& surveyed, const std::vector<int>& vertices,
                                        DistanceMeasure measure) {
    if (measure == DistanceMeasure::Geodesic) return surveyed.geodesics->from_vertices(vertices);
    return edge_distances(surveyed.mesh, vertex_points(surveyed.mesh, vertices));
  }

  Eigen::VectorXd distances_between(std::size_t region, const RingsRegion& rings) {
    Surveyed& surveyed = survey(rings.source);
    const bool are_geodesic = rings.distance == DistanceMeasure::Geodesic;
    const Rings found = find_rings(
        surveyed.mesh, points(rings.source, rings.inner), points(rings.source, rings.outer),
        are_geodesic ? &*surveyed.geodesics : nullptr, location_of(recipe_, region, "rings"));
    return ring_distance(found, distances_from(surveyed, found.inner, rings.distance),
                         distances_from(surveyed, found.outer, rings.distance));
  }

  RegionField field_of(std::size_t region) {
    const RegionOfInterest& of = recipe_.regions[region];
    RegionField field;
    field.falloff = of.falloff;
    if (const auto* ball = std::get_if<BallRegion>(&of.shape)) {
      const double unit = survey(ball->source).unit;
      field.form = soft_step(distances(region, ball->source, ball->distance), ball->inner * unit,
                             ball->outer * unit);
    } else if (const auto* rings = std::get_if<RingsRegion>(&of.shape)) {
      field.form = distances_between(region, *rings);
    } else if (std::holds_alternative<MaskRegion>(of.shape)) {
      field.form = (1 - masks_[region].array()).matrix().eval();
    } else if (const auto* scattered = std::get_if<ScatteredRegion>(&of.shape)) {
      field.form = scattered_distance(region, *scattered);
    } else if (const auto* spatial = std::get_if<SpatialRegion>(&of.shape)) {
      field = spatial_field(region, *spatial);
    } else if (const auto* flood = std::get_if<FloodRegion>(&of.shape)) {
      field.form = flood_field(region, *flood);
      field.floods = true;
    } else {
      field.form = std::get<CombinedRegion>(of.shape);
      return field;
    }
    if (auto* d = std::get_if<Eigen::VectorXd>(&field.form)) *d = bent_by(field.falloff, *d);
    return field;
  }

  Eigen::VectorXd scattered_distance(std::size_t region, const ScatteredRegion& scattered) {
    std::vector<Place> places;
    for (const ScatteredValue& each : scattered.values) places.push_back(each.at);
    const PointSet at = points(scattered.source, places);
    std::vector<FixedValue> fixed;
    for (std::size_t i = 0; i < at.size(); ++i) {
      fixed.push_back(
          {nearest_corner(survey(scattered.source).mesh, at[i]), scattered.values[i].value});
    }
    check_agree(region, scattered, fixed);
    check_reached(region, scattered.source, fixed);
    return 1 - spread_values(mesh_.connectivity, fixed).array().max(0).min(1);
  }

  /// Points at one vertex have one value.
  void check_agree(std::size_t region, const ScatteredRegion& scattered,
                   const std::vector<FixedValue>& fixed) {
    std::map<int, std::size_t> first;
    for (std::size_t i = 0; i < fixed.size(); ++i) {
      const std::size_t other = first.try_emplace(fixed[i].vertex, i).first->second;
      if (fixed[i].value == fixed[other].value) continue;
      const std::string pointer = child_pointer("scattered/values", scattered.values[i].name);
      throw BakeError(Problem{
          Severity::Error, "recipe.conflicting-fields", location_of(recipe_, region, pointer),
          fmt::format("it lies at the same vertex as \"{}\", which has another value",
                      scattered.values[other].name),
          "give both the same value, or leave one out"});
    }
  }

  /// Each piece of the surface needs a value of its own.
  void check_reached(std::size_t region, int source, const std::vector<FixedValue>& fixed) {
    const Components components = connected_components(one_rings(mesh_.connectivity));
    std::vector<bool> reached(static_cast<std::size_t>(components.count), false);
    for (const FixedValue& each : fixed) {
      reached[static_cast<std::size_t>(components.label[static_cast<std::size_t>(each.vertex)])] =
          true;
    }
    complain_unreached(region, "scattered", source, components, reached);
  }

  void complain_unreached(std::size_t region, const std::string& kind, int source,
                          const Components& components, const std::vector<bool>& reached) {
    const auto missed = std::find(reached.begin(), reached.end(), false);
    if (missed == reached.end()) return;
    const auto label = static_cast<int>(missed - reached.begin());
    const auto vertex = std::find(components.label.begin(), components.label.end(), label) -
                        components.label.begin();
    const Eigen::RowVector3d at = mesh_.geometries[static_cast<std::size_t>(source)].row(vertex);
    throw BakeError(Problem{
        Severity::Error, "recipe.unreached", location_of(recipe_, region, kind),
        fmt::format("the surface has {} pieces, and no point of this region lies on the one "
                    "at ({:.4g}, {:.4g}, {:.4g})",
                    components.count, at.x(), at.y(), at.z()),
        "give a point on each piece"});
  }

  void check_expression(std::size_t region, const SpatialRegion& spatial) {
    const auto* expression = std::get_if<Expression>(&spatial.shape);
    const std::string error = expression != nullptr ? expression_error(expression->text) : "";
    if (error.empty()) return;
    throw BakeError(Problem{
        Severity::Error, "recipe.expression", location_of(recipe_, region, "spatial/expression"),
        fmt::format("\"{}\" cannot be read: {}", expression->text, error),
        "it has x, y, z and t, numbers, + - * / ^, comparisons, ?: and functions "
        "such as sin(x), min(x, y)"});
  }

  RegionField spatial_field(std::size_t region, const SpatialRegion& spatial) {
    check_expression(region, spatial);
    RegionField field;
    field.falloff = recipe_.regions[region].falloff;
    const bool is_expression = std::holds_alternative<Expression>(spatial.shape);
    SpatialField form{
        spatial,
        {},
        location_of(recipe_, region, is_expression ? "spatial/expression" : "spatial")};
    const std::vector<int> sources =
        spatial.sources.empty() ? sources_with_a_share(recipe_) : spatial.sources;
    for (const int source : sources) {
      auto& coordinates = coordinates_[source];
      if (!coordinates) {
        const Surveyed& surveyed = survey(source);
        coordinates = std::make_shared<const Positions>(
            centred_coordinates(surveyed.mesh, surveyed.unit > 0 ? surveyed.unit : 1));
      }
      form.coordinates.push_back(coordinates);
    }
    field.moves = moves_with_time(spatial);
    // Evaluated once in any case: an expression that gives no number is told before anything moves.
    Eigen::VectorXd d = spatial_distance(form, 0);
    if (field.moves) {
      field.form = std::move(form);
    } else {
      field.form = std::move(d);
    }
    return field;
  }

  FloodField flood_field(std::size_t region, const FloodRegion& flood) {
    const Eigen::VectorXd r = distances(region, flood.source, flood.distance);
    const Components components = connected_components(one_rings(mesh_.connectivity));
    std::vector<bool> reached(static_cast<std::size_t>(components.count), true);
    for (Eigen::Index v = 0; v < r.size(); ++v) {
      if (std::isfinite(r(v))) continue;
      reached[static_cast<std::size_t>(components.label[static_cast<std::size_t>(v)])] = false;
    }
    complain_unreached(region, "flood", flood.source, components, reached);
    return {flood_order(r, survey(flood.source).mesh.positions, flood.softness), flood.softness};
  }

  /// Combinations of fixed regions are fixed; others wait for their moment.
  void settle_combination(RegionFields& fields, std::vector<bool>& done, std::size_t region) {
    if (done[region]) return;
    done[region] = true;
    const auto* combined = std::get_if<CombinedRegion>(&fields[region].form);
    if (combined == nullptr) return;
    for (const int part : combined->regions) {
      const auto p = static_cast<std::size_t>(part);
      settle_combination(fields, done, p);
      fields[region].moves = fields[region].moves || fields[p].moves;
      fields[region].floods = fields[region].floods || fields[p].floods;
    }
    if (fields[region].moves || fields[region].floods) return;
    fields[region].form = distance_at(fields, static_cast<int>(region), {});
  }

  const MorphableMesh& mesh_;
  const Recipe& recipe_;
  const std::vector<Eigen::VectorXd>& masks_;
  std::vector<std::optional<RegionField>> known_;  // one a region
  std::vector<StartingPoints> sets_;               // one a region
  std::map<int, Surveyed> surveyed_;
  std::map<int, std::shared_ptr<const Positions>> coordinates_;
};

}  // namespace

RegionFields region_fields(const MorphableMesh& mesh, const Recipe& recipe,
                           const std::vector<Eigen::VectorXd>& masks,
                           std::vector<std::optional<RegionField>> known) {
  return RegionBuilder(mesh, recipe, masks, std::move(known)).build();
}

}  // namespace morphbake
