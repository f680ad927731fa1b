#include "morphbake/bake/derive_sources.h"

#include <fmt/core.h>

#include <array>
#include <numbers>
#include <string>
#include <utility>

#include "morphbake/derive/band.h"
#include "morphbake/derive/direction.h"
#include "morphbake/derive/free_form.h"
#include "morphbake/derive/mirror.h"
#include "morphbake/derive/transform.h"
#include "morphbake/json/json.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/surface_point.h"

namespace morphbake {
namespace {

constexpr double kInside = 1e-12;  // d of vertices that count as inside, and 1 - d of those outside

/// What one derived source is made from.
struct Derivation {
  const Recipe& recipe;
  const RegionFields& regions;
  const MorphableMesh& mesh;
  const DerivedSource& derived;
  Mesh shape;       ///< that it is made from
  double unit = 1;  ///< scene units of 1 in the recipe's
};

[[noreturn]] void fail(const Derivation& from, const std::string& field, const char* code,
                       const std::string& message, const std::string& hint) {
  const std::string pointer = child_pointer("/sources", from.derived.name);
  throw BakeError(
      Problem{Severity::Error, code, location_in(from.recipe, pointer + field), message, hint});
}

/// d of a region that an edit names.
const Eigen::VectorXd& still_distance(const Derivation& from, int region,
                                      const std::string& field) {
  const RegionField& named = from.regions[static_cast<std::size_t>(region)];
  if (!named.moves && !named.floods) return fixed_distance(from.regions, region);
  fail(from, field, "recipe.moving-region",
       fmt::format("the region {} changes with time",
                   from.recipe.regions[static_cast<std::size_t>(region)].name),
       "an edit needs a region that stands still");
}

/// What a movement does to the surroundings of what it moves. A stretch along one direction does
/// nothing to them.
void set_turn(const Movement& movement, Handle& handle) {
  if (movement.degrees != 0) {
    handle.turn = unit_direction(movement.axis, "axis of the handle") * movement.degrees *
                  std::numbers::pi / 180;
  }
  if (!movement.scale_along && movement.scale > 0) handle.growth = movement.scale;
}

Transform transform_of(const Movement& movement, double unit) {
  Transform transform;
  transform.scale = movement.scale;
  transform.scale_along = movement.scale_along;
  transform.axis = movement.axis;
  transform.degrees = movement.degrees;
  transform.translation = movement.translate * unit;
  return transform;
}

/// Vertices inside of a region, moved about their own middle.
Handle region_handle(const Derivation& from, const EditHandle& handle, const std::string& field) {
  const Eigen::VectorXd& d = still_distance(from, handle.region, field + "/region");
  Handle moved;
  for (int v = 0; v < d.size(); ++v) {
    if (d(v) <= kInside) moved.vertices.push_back(v);
  }
  if (moved.vertices.empty()) {
    fail(from, field + "/region", "recipe.empty-handle",
         fmt::format("no vertex lies inside of the region {}",
                     from.recipe.regions[static_cast<std::size_t>(handle.region)].name),
         "give it a larger inside, or name a point by \"at\"");
  }
  const Positions rest = from.shape.positions(moved.vertices, Eigen::all);
  const Transform transform = transform_of(std::get<Movement>(handle.to), from.unit);
  moved.positions = mapped(rest, map_of(transform, rest.colwise().mean().transpose()));
  set_turn(std::get<Movement>(handle.to), moved);
  return moved;
}

/// One a handle: the vertex nearest to its point of the source with the file, or -1 for regions.
std::vector<int> vertices_of(const Derivation& from, const std::vector<EditHandle>& handles) {
  const Mesh root{from.mesh.geometries[static_cast<std::size_t>(from.derived.root)],
                  from.mesh.connectivity.triangles};
  std::vector<int> vertices(handles.size(), -1);
  std::vector<std::size_t> at_points;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    if (handles[i].region < 0) at_points.push_back(i);
  }
  Positions wanted(static_cast<Eigen::Index>(at_points.size()), 3);
  for (Eigen::Index k = 0; k < wanted.rows(); ++k) {
    const EditHandle& handle = handles[at_points[static_cast<std::size_t>(k)]];
    wanted.row(k) = std::get<Eigen::Vector3d>(handle.at).transpose();
  }
  if (at_points.empty()) return vertices;
  const std::vector<SurfacePoint> found = closest_points(root, wanted);
  for (std::size_t k = 0; k < found.size(); ++k) {
    vertices[at_points[k]] = nearest_corner(root, found[k]);
  }
  return vertices;
}

Handle vertex_handle(const Derivation& from, const EditHandle& handle, int vertex) {
  Handle moved;
  moved.vertices = {vertex};
  const Positions rest = from.shape.positions(moved.vertices, Eigen::all);
  if (const auto* target = std::get_if<HandleTarget>(&handle.to)) {
    moved.positions = std::get<Eigen::Vector3d>(target->at).transpose();
  } else {
    const Transform transform = transform_of(std::get<Movement>(handle.to), from.unit);
    moved.positions = mapped(rest, map_of(transform, rest.row(0).transpose()));
    set_turn(std::get<Movement>(handle.to), moved);
  }
  return moved;
}

Positions edited(const Derivation& from, const EditSource& edit, const Observer& observer) {
  const Eigen::VectorXd& d = still_distance(from, edit.region, "/edit/region");
  std::vector<bool> fixed;
  for (const double each : d) fixed.push_back(each >= 1 - kInside);
  const std::vector<int> vertices = vertices_of(from, edit.handles);
  std::vector<Handle> handles;
  for (std::size_t i = 0; i < edit.handles.size(); ++i) {
    const EditHandle& handle = edit.handles[i];
    const std::string field = child_pointer("/edit/handles", i);
    handles.push_back(handle.region >= 0 ? region_handle(from, handle, field)
                                         : vertex_handle(from, handle, vertices[i]));
  }
  const Surroundings surroundings = edit.turns ? Surroundings::Turned : Surroundings::AsTheyAre;
  return free_form(from.shape, fixed, handles, surroundings, observer);
}

Positions band_of(const Derivation& from, const BandSource& band, const Observer& observer) {
  const int highest = from.mesh.connectivity.vertex_count - 1;
  return band_limited(from.shape, {band.first, band.last.value_or(highest)}, {}, observer);
}

Positions mirror_of(const Derivation& from, const MirrorSource& mirror, const Observer& observer) {
  // The recipe's offset is a length, however long the normal is.
  const MirrorPlane plane{unit_direction(mirror.normal, "normal of the mirror plane"),
                          mirror.offset};
  if (mirror.symmetric < 0) return mirrored(from.shape, plane, observer);
  return mirrored(from.shape, plane,
                  from.mesh.geometries[static_cast<std::size_t>(mirror.symmetric)], observer);
}

Positions geometry_of(const Derivation& from, const Observer& observer) {
  const auto& how = from.derived.how;
  if (const auto* band = std::get_if<BandSource>(&how)) return band_of(from, *band, observer);
  if (const auto* edit = std::get_if<EditSource>(&how)) return edited(from, *edit, observer);
  if (const auto* mirror = std::get_if<MirrorSource>(&how)) {
    return mirror_of(from, *mirror, observer);
  }
  return transformed(from.shape, transform_of(std::get<TransformSource>(how).movement, from.unit));
}

/// The field of a source that says how it is derived.
std::string field_of(const DerivedSource& derived) {
  constexpr std::array kFields = {"/band", "/edit", "/mirror", "/transform"};
  return kFields[derived.how.index()];
}

/// The same problems, in the recipe where they have no file: their pointers begin where the source
/// is described.
BakeError placed(const BakeError& error, const Derivation& from) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    if (!problem.location.file.empty()) continue;
    problem.location =
        location_in(from.recipe, child_pointer("/sources", from.derived.name) +
                                     field_of(from.derived) + problem.location.pointer);
  }
  return BakeError(std::move(problems));
}

}  // namespace

void derive_sources(const Recipe& recipe, const RegionFields& regions, MorphableMesh& mesh,
                    const Observer& observer) {
  for (const DerivedSource& derived : recipe.derived) {
    stop_if_cancelled(observer);
    Derivation from{recipe, regions, mesh, derived, {}, 1};
    from.shape = {mesh.geometries[static_cast<std::size_t>(derived.of)],
                  mesh.connectivity.triangles};
    if (recipe.units == Units::Diagonal) from.unit = bounding_diagonal(from.shape.positions);
    try {
      mesh.geometries.push_back(geometry_of(from, observer));
    } catch (const BakeError& error) {
      throw placed(error, from);
    }
    mesh.names.push_back(derived.name);
  }
}

}  // namespace morphbake
