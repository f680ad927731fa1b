#pragma once

// Internal to bake/: the reports' parts as JSON and back, field by field, for the cache. What
// --report writes is made for readers (report.cpp).

#include <Eigen/Core>
#include <optional>

#include "morphbake/bake/bake.h"
#include "morphbake/json/json.h"

// NOLINTBEGIN(cert-dcl58-cpp): nlohmann's way to teach it types of others
template <typename Value>
struct nlohmann::adl_serializer<std::optional<Value>> {
  static void to_json(nlohmann::json& json, const std::optional<Value>& value) {
    json = value ? nlohmann::json(*value) : nlohmann::json();
  }

  static void from_json(const nlohmann::json& json, std::optional<Value>& value) {
    if (json.is_null()) {
      value.reset();
    } else {
      value = json.get<Value>();
    }
  }
};

template <>
struct nlohmann::adl_serializer<Eigen::RowVector3d> {
  static void to_json(nlohmann::json& json, const Eigen::RowVector3d& vector) {
    json = {vector.x(), vector.y(), vector.z()};
  }

  static void from_json(const nlohmann::json& json, Eigen::RowVector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) vector(axis) = json.at(axis).get<double>();
  }
};

// NOLINTEND(cert-dcl58-cpp)

namespace morphbake {

NLOHMANN_JSON_SERIALIZE_ENUM(ConnectivityMode, {{ConnectivityMode::Shared, "shared"},
                                                {ConnectivityMode::Remesh, "remesh"},
                                                {ConnectivityMode::Resample, "resample"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SurfaceRepairs, degenerate, duplicate, turned)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SourceRepairs, source, repairs)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TextureReport, size, charts, covered)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StageReport, name, seconds)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SphereQuality, flipped_triangles, covering)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SourceQuality, source, source_to_remesh, remesh_to_source, folds,
                                   self_intersections, source_self_intersections,
                                   new_self_intersections, smallest_angle, longest_edge,
                                   landmark_error, sphere)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MapQuality, source, mean, median, percentile_95, percentile_99,
                                   maximum)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DistortionRegion, source, triangles, area_share,
                                   other_area_share, centre, nearest_landmark, landmark_distance,
                                   ends_on_other, end, end_distance)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TriangulationQuality, sources, maps, regions)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ConnectivityReport, mode, vertices, triangles, repairs, steps,
                                   texture, quality)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Convergence, iterations, residual, error, reached)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SolveRecord, name, time, convergence)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SolveReport, representation, representation_reason, solver,
                                   reason, unknowns, held, factor_bytes, solves)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NormalReport, maximum, percentile_99, time, vertex)
// But for what the output itself tells: where it is, how large, which pictures it has.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OutputReport, kind, targets, weight_keys, max_error, worst_time,
                                   worst_vertex, normals)
// What the stages before the outputs tell.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BakeReport, vertices, triangles, components, frames,
                                   connectivity, solve)

}  // namespace morphbake
