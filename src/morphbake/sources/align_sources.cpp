#include "morphbake/sources/align_sources.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "morphbake/json/json.h"
#include "morphbake/mesh/centre_of_mass.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/recipe/places.h"
#include "morphbake/sources/common_landmarks.h"
#include "morphbake/sources/places.h"

namespace morphbake {
namespace {

using Eigen::Affine3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kFlat = 1e-6;     // of the largest extent: no direction at all
constexpr double kUnlikeSize = 4;  // times

/// Landmarks of two sources that have one name; columns correspond.
struct LandmarkPairs {
  Matrix3Xd from;
  Matrix3Xd to;
};

/// Where landmarks of these names are.
Matrix3Xd landmark_positions(const SourceMesh& source, const SourceRef& ref,
                             const std::vector<std::string>& names) {
  Matrix3Xd positions(3, static_cast<Eigen::Index>(names.size()));
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    const auto landmark = std::find_if(ref.landmarks.begin(), ref.landmarks.end(),
                                       [&](const Landmark& each) { return each.name == name; });
    Location location = ref.landmarks_at;
    location.pointer = child_pointer(location.pointer, name);
    positions.col(i) = scene_position(source, landmark->at, location);
  }
  return positions;
}

/// How many directions points extend in: 0 to 3.
int dimension(const Matrix3Xd& points) {
  const Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::JacobiSVD<Matrix3Xd> svd(centred);
  const double largest = svd.singularValues()(0);
  if (!(largest > 0)) return 0;
  return static_cast<int>((svd.singularValues().array() > kFlat * largest).count());
}

/// Where a surface stands and how large it is.
struct Extent {
  Vector3d centre;    ///< of area
  double radius = 0;  ///< root mean square distance from it
};

Extent extent_of(const SourceMesh& source) {
  const Eigen::VectorXd areas = vertex_areas(source.positions, source.triangles);
  const double whole = areas.sum();
  Extent extent;
  extent.centre = centre_of_mass(source.positions, source.triangles);
  const Eigen::VectorXd squares =
      (source.positions.rowwise() - extent.centre.transpose()).rowwise().squaredNorm();
  extent.radius = std::sqrt(squares.dot(areas) / whole);
  return extent;
}

Affine3d map_of_extents(Align align, const SourceMesh& from, const SourceMesh& to) {
  const Extent a = extent_of(from), b = extent_of(to);
  Affine3d map = Affine3d::Identity();
  map.translate(b.centre);
  if (align == Align::Similarity) map.scale(b.radius / a.radius);
  map.translate(-a.centre);
  return map;
}

Affine3d affine_map(const LandmarkPairs& marks) {
  const Vector3d from_centre = marks.from.rowwise().mean(), to_centre = marks.to.rowwise().mean();
  const Matrix3Xd from = marks.from.colwise() - from_centre;
  const Matrix3Xd to = marks.to.colwise() - to_centre;
  Affine3d map = Affine3d::Identity();
  map.linear() = (to * from.transpose()) * (from * from.transpose()).inverse();
  map.translation() = to_centre - map.linear() * from_centre;
  return map;
}

Affine3d landmark_map(Align align, const LandmarkPairs& marks) {
  if (align == Align::Affine) return affine_map(marks);
  Affine3d map = Affine3d::Identity();
  if (align == Align::Translation) {
    map.translation() = marks.to.rowwise().mean() - marks.from.rowwise().mean();
  } else {
    map.matrix() = Eigen::umeyama(marks.from, marks.to, align == Align::Similarity);
  }
  return map;
}

[[noreturn]] void refuse(const Recipe& recipe, std::size_t s, const std::string& message,
                         const std::string& hint) {
  throw BakeError(
      Problem{Severity::Error, "landmarks.cannot-align",
              location_in(recipe, child_pointer("/sources", recipe.sources[s].name) + "/align"),
              message, hint});
}

/// The map of source `s` onto the first one.
Affine3d alignment(const Recipe& recipe, const std::vector<SourceMesh>& sources, std::size_t s) {
  const Align align = recipe.sources[s].align;
  const std::vector<std::string> names =
      common_landmark_names({recipe.sources[0], recipe.sources[s]});
  const LandmarkPairs marks{landmark_positions(sources[s], recipe.sources[s], names),
                            landmark_positions(sources[0], recipe.sources[0], names)};
  const bool is_affine = align == Align::Affine;
  if (names.size() < kFewestLandmarks && !is_affine)
    return map_of_extents(align, sources[s], sources[0]);
  if (align != Align::Translation) {
    const int needed = is_affine ? 3 : 2;
    if (marks.from.cols() <= needed || dimension(marks.from) < needed ||
        dimension(marks.to) < needed) {
      refuse(recipe, s,
             fmt::format("{} landmarks that \"{}\" has in common with \"{}\" do not say how to "
                         "align them",
                         marks.from.cols(), recipe.sources[s].name, recipe.sources[0].name),
             is_affine ? "give four that are not in one plane, or write \"similarity\""
                       : "give one that is not in line with the others, or write \"translation\"");
    }
  }
  const Affine3d map = landmark_map(align, marks);
  if (!map.matrix().allFinite() || map.linear().determinant() <= 0) {
    refuse(recipe, s,
           fmt::format("the landmarks of \"{}\" would be mirrored or flattened to meet those of "
                       "\"{}\"",
                       recipe.sources[s].name, recipe.sources[0].name),
           "see whether left and right are exchanged, or write \"similarity\"");
  }
  return map;
}

void move_positions(Recipe& recipe, std::size_t s, const Affine3d& map) {
  const auto move = [&](Place& place) {
    if (auto* at = std::get_if<Vector3d>(&place)) *at = map * *at;
  };
  const int source = static_cast<int>(s);
  for (Landmark& landmark : recipe.sources[s].landmarks) move(landmark.at);
  visit_places(recipe, [&](Place& place, int on, const std::string&, Whereabouts) {
    if (on == source) move(place);
  });
}

struct Unlikeness {
  double ratio = 1;  ///< of sizes
  double away = 0;   ///< distance of the centres, in the larger radius

  bool in_size() const { return ratio > kUnlikeSize || ratio < 1 / kUnlikeSize; }

  bool in_place() const { return away > kUnlikeSize; }
};

Unlikeness unlikeness(const SourceMesh& first_source, const SourceMesh& other_source) {
  const Extent first = extent_of(first_source), other = extent_of(other_source);
  return {other.radius / first.radius,
          (other.centre - first.centre).norm() / std::max(first.radius, other.radius)};
}

/// Tells of a source that one would hardly see beside the first one.
void warn_of_unlike(const Recipe& recipe, const std::vector<SourceMesh>& sources, std::size_t s,
                    const Observer& observer) {
  const Unlikeness unlike = unlikeness(sources[0], sources[s]);
  std::string message;
  if (unlike.in_size()) {
    message = fmt::format("\"{}\" is {:.3g} times as large as \"{}\"", recipe.sources[s].name,
                          unlike.ratio, recipe.sources[0].name);
  } else if (unlike.in_place()) {
    message = fmt::format("\"{}\" stands {:.3g} times its own radius away from \"{}\"",
                          recipe.sources[s].name, unlike.away, recipe.sources[0].name);
  }
  if (message.empty()) return;
  report(observer, {Severity::Warning, "sources.unlike",
                    location_in(recipe, child_pointer("/sources", recipe.sources[s].name)), message,
                    "if that is not meant, write \"align\": \"similarity\" beside its \"file\""});
}

}  // namespace

bool is_unlike(const SourceMesh& first, const SourceMesh& other) {
  const Unlikeness unlike = unlikeness(first, other);
  return unlike.in_size() || unlike.in_place();
}

AlignedSources align_sources(Recipe recipe, std::vector<SourceMesh> sources,
                             const Observer& observer) {
  for (std::size_t s = 1; s < sources.size(); ++s) {
    if (recipe.sources[s].align == Align::None) {
      warn_of_unlike(recipe, sources, s, observer);
      continue;
    }
    const Affine3d map = alignment(recipe, sources, s);
    Positions& positions = sources[s].positions;
    positions =
        ((positions * map.linear().transpose()).rowwise() + map.translation().transpose()).eval();
    move_positions(recipe, s, map);
  }
  return {std::move(recipe), std::move(sources)};
}

}  // namespace morphbake
