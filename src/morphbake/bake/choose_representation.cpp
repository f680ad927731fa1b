#include "morphbake/bake/choose_representation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "morphbake/differential/rotation_vector.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {
namespace {

constexpr double kSharpTurn = 0.8;    // radians along an edge
constexpr double kManySharp = 0.001;  // of all edges: more are no mistakes at single places
constexpr double kShrinking = 0.02;   // of lengths, half-way: what is seen

/// How far one shape is turned against another.
struct Turning {
  double shrinking = 0;  ///< share of its length that an edge loses half-way, on the mean
  double sharp = 0;      ///< share of the edges that turn by more than kSharpTurn
  double sharpest = 0;   ///< radians
  Edge where;            ///< the sharpest
};

/// Rotation and turns of a shape; the first one's are none.
struct TurnedShape {
  const Deformation* deformation = nullptr;

  Eigen::Quaterniond rotation(std::size_t vertex) const {
    return deformation == nullptr ? Eigen::Quaterniond::Identity() : deformation->rotations[vertex];
  }

  Eigen::Vector3d turn(std::size_t edge) const {
    return deformation == nullptr ? Eigen::Vector3d::Zero() : deformation->turns[edge];
  }
};

TurnedShape turned_shape(const SourceDeformations& deformations, int shape) {
  if (shape == 0) return {};
  return {&deformations.against_first[static_cast<std::size_t>(shape - 1)]};
}

Turning turning_between(const SourceDeformations& deformations, int from, int to,
                        const Eigen::VectorXd& areas) {
  const TurnedShape a = turned_shape(deformations, from), b = turned_shape(deformations, to);
  Turning turning;
  for (Eigen::Index v = 0; v < areas.size(); ++v) {
    const auto vertex = static_cast<std::size_t>(v);
    // Two unit vectors at an angle have a mean as long as the cosine of half of it.
    const double angle = a.rotation(vertex).angularDistance(b.rotation(vertex));
    turning.shrinking += areas(v) * (1 - std::cos(angle / 2));
  }
  if (areas.sum() > 0) turning.shrinking /= areas.sum();
  std::size_t sharp = 0;
  for (std::size_t e = 0; e < deformations.edges.size(); ++e) {
    const double turn = (b.turn(e) - a.turn(e)).norm();
    if (turn > kSharpTurn) ++sharp;
    if (turn <= turning.sharpest) continue;
    turning.sharpest = turn;
    turning.where = deformations.edges[e];
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, deformations.edges.size()));
  turning.sharp = static_cast<double>(sharp) / count;
  return turning;
}

/// Of the shapes that have a share, which one is turned most against the first of them, by a
/// measure.
struct MostTurned {
  int from = 0, to = 0;
  Turning shrinks, sharp;
  int sharp_to = 0;
};

MostTurned most_turned(const Recipe& recipe, const MorphableMesh& mesh,
                       const SourceDeformations& deformations) {
  const std::vector<int> shapes = shapes_with_a_share(recipe);
  const Eigen::VectorXd areas = vertex_areas(
      mesh.geometries[static_cast<std::size_t>(shapes.front())], mesh.connectivity.triangles);
  MostTurned most;
  most.from = most.to = most.sharp_to = shapes.front();
  for (const int shape : shapes) {
    const Turning turning = turning_between(deformations, most.from, shape, areas);
    if (turning.shrinking > most.shrinks.shrinking) {
      most.shrinks = turning;
      most.to = shape;
    }
    if (std::tie(turning.sharp, turning.sharpest) >
        std::tie(most.sharp.sharp, most.sharp.sharpest)) {
      most.sharp = turning;
      most.sharp_to = shape;
    }
  }
  return most;
}

/// What of the recipe only plain differences give, or "".
std::string what_needs_differences(const Recipe& recipe) {
  if (has_shares_an_axis(recipe)) return "axes mix by themselves";
  if (recipe.gauge.kind == Gauge::Kind::Anchor) return "an anchor is for plain differences";
  for (const Output& output : recipe.outputs) {
    if (!output.still && output.targets == TargetKind::Tracks) return "an output asks for tracks";
  }
  return "";
}

std::string percent(double share) {
  return share < 0.1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::string sharp_turns(const MostTurned& most) {
  return fmt::format(
      ", but {} of them turn by more than {} rad against their neighbours; \"rotation\" turns them "
      "along all the same",
      percent(most.sharp.sharp), kSharpTurn);
}

std::string shrinking(const MorphableMesh& mesh, const MostTurned& most) {
  return fmt::format("half-way from \"{}\" to \"{}\" edges lose {} of their length by their turns",
                     mesh.names[static_cast<std::size_t>(most.from)],
                     mesh.names[static_cast<std::size_t>(most.to)],
                     percent(most.shrinks.shrinking));
}

/// What has no extent cannot be turned, nor anything against it.
void require_extent(const Recipe& recipe, const MorphableMesh& mesh, const MostTurned& most) {
  const auto first = static_cast<std::size_t>(most.from);
  if (bounding_diagonal(mesh.geometries[first]) > 0) return;
  throw BakeError(Problem{
      Severity::Error, "solve.no-extent", location_in(recipe, "/representation"),
      fmt::format("\"{}\" is a single point: nothing is turned against it", mesh.names[first]),
      "name a source that has a surface first, or write \"laplacian\" here"});
}

void warn_of_sharp_turns(const Recipe& recipe, const MorphableMesh& mesh, const MostTurned& most,
                         const Observer& observer) {
  if (most.sharp.sharpest <= kSharpTurn) return;
  const Positions& first = mesh.geometries[static_cast<std::size_t>(most.from)];
  const Eigen::RowVector3d at = (first.row(most.sharp.where.a) + first.row(most.sharp.where.b)) / 2;
  report(
      observer,
      Problem{Severity::Warning, "solve.sharp-turns", location_in(recipe, "/representation"),
              fmt::format("from \"{}\" to \"{}\" {} of the edges turn by more than "
                          "{} rad against their neighbours, most of all ({:.2g} rad) the one at "
                          "({:.4g}, {:.4g}, {:.4g}) of \"{}\": which way is between is not clear "
                          "there",
                          mesh.names[static_cast<std::size_t>(most.from)],
                          mesh.names[static_cast<std::size_t>(most.sharp_to)],
                          percent(most.sharp.sharp), kSharpTurn, most.sharp.sharpest, at.x(),
                          at.y(), at.z(), mesh.names[static_cast<std::size_t>(most.from)]),
              "more vertices or landmarks there help; \"laplacian\" blends without rotations"});
}

}  // namespace

RepresentationChoice choose_representation(const Recipe& recipe, const MorphableMesh& mesh,
                                           const Observer& observer) {
  RepresentationChoice choice;
  choice.representation = recipe.representation;
  choice.reason = "as the recipe says";
  if (recipe.representation != Representation::Auto &&
      recipe.representation != Representation::Rotation) {
    return choice;
  }
  choice.deformations = std::make_shared<SourceDeformations>(source_deformations(mesh));
  const MostTurned most = most_turned(recipe, mesh, *choice.deformations);
  if (recipe.representation == Representation::Rotation) {
    require_extent(recipe, mesh, most);
  } else {
    const bool is_turned = most.shrinks.shrinking > kShrinking;
    const bool is_clear = most.sharp.sharp <= kManySharp;
    const std::string needs = what_needs_differences(recipe);
    choice.reason = shrinking(mesh, most);
    if (!needs.empty()) choice.reason = is_turned ? needs + ", though " + choice.reason : needs;
    if (needs.empty() && is_turned && !is_clear) choice.reason += sharp_turns(most);
    choice.representation = needs.empty() && is_turned && is_clear ? Representation::Rotation
                                                                   : Representation::Laplacian;
  }
  if (choice.representation == Representation::Laplacian) {
    choice.deformations.reset();
  } else {
    warn_of_sharp_turns(recipe, mesh, most, observer);
  }
  return choice;
}

}  // namespace morphbake
