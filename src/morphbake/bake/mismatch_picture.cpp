#include "morphbake/bake/mismatch_picture.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "morphbake/images/drawing.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/preview/still_view.h"

namespace morphbake {
namespace {

constexpr int kCell = 560;           // pixels of a picture
constexpr double kReach = 5;         // of a close picture, in sides of the triangle at its middle
constexpr double kShortestEdge = 5;  // pixels: shorter ones would only darken the picture
constexpr Ink kText = {{70, 66, 62}, 1};
constexpr Ink kEdge = {{40, 30, 25}, 0.5F};
constexpr Ink kRing = {{20, 60, 200}, 1};
const Eigen::Vector3f kGrey(0.55F, 0.55F, 0.53F);  // linear RGB
const Eigen::Vector3f kRed(0.75F, 0.01F, 0.01F);

using Spot = MismatchPlace::Spot;

/// What is shown of one source.
struct Subject {
  const SourceMesh& source;
  const std::vector<int>& unlike;    ///< its triangles that differ
  std::vector<Spot> spots;           ///< those of the places that it has
  const std::optional<Spot>& first;  ///< of the first place
};

Eigen::RowVector3d corner(const SourceMesh& source, int triangle, int k) {
  return source.positions.row(source.triangles(triangle, k));
}

Eigen::Vector3d area_normal(const SourceMesh& source, int triangle) {
  const Eigen::Vector3d a = corner(source, triangle, 0), b = corner(source, triangle, 1),
                        c = corner(source, triangle, 2);
  const bool is_mirrored = source.geometry.to_scene.topLeftCorner<3, 3>().determinant() < 0;
  return is_mirrored ? (c - a).cross(b - a) : (b - a).cross(c - a);
}

/// Mean normal of the triangles that share a point with that of the first place; if there are any,
/// of those that are alike: what differs may lie anyhow.
Eigen::Vector3d normal_around(const Subject& subject) {
  const SourceMesh& source = subject.source;
  const auto here = source.triangles.row(subject.first->triangle);
  Eigen::Vector3d alike = Eigen::Vector3d::Zero(), unlike = alike;
  for (int f = 0; f < source.triangles.rows(); ++f) {
    const auto there = source.triangles.row(f);
    const bool touches = std::any_of(there.begin(), there.end(), [&](int r) {
      const int vertex = source.welded[static_cast<std::size_t>(r)];
      return std::any_of(here.begin(), here.end(), [&](int own) {
        return source.welded[static_cast<std::size_t>(own)] == vertex;
      });
    });
    if (!touches) continue;
    const bool differs = std::binary_search(subject.unlike.begin(), subject.unlike.end(), f);
    (differs ? unlike : alike) += area_normal(source, f);
  }
  return alike.isZero(0) ? unlike : alike;
}

/// Turns a direction to the camera, which looks from +Z: around Y, then tilted.
Eigen::Matrix3d facing(const Eigen::Vector3d& direction) {
  if (!(direction.norm() > 0)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d d = direction.normalized();
  const Eigen::AngleAxisd around(-std::atan2(d.x(), d.z()), Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd tilt(std::asin(std::clamp(d.y(), -1.0, 1.0)), Eigen::Vector3d::UnitX());
  return (tilt * around).toRotationMatrix();
}

/// Every corner of some triangles and every place, turned, about the origin and of size 1: the
/// numbers of a picture are floats.
Positions points_of(const Subject& subject, const std::vector<int>& shown,
                    const Eigen::Matrix3d& turn) {
  const SourceMesh& source = subject.source;
  const Eigen::RowVector3d low = source.positions.colwise().minCoeff();
  const Eigen::RowVector3d high = source.positions.colwise().maxCoeff();
  const double diagonal = (high - low).norm();
  Positions points(static_cast<Eigen::Index>(3 * shown.size() + subject.spots.size()), 3);
  Eigen::Index row = 0;
  for (const int f : shown) {
    for (int k = 0; k < 3; ++k) points.row(row++) = corner(source, f, k);
  }
  for (const Spot& spot : subject.spots) points.row(row++) = spot.position;
  points.rowwise() -= (low + high) / 2;
  return (diagonal > 0 ? Positions(points / diagonal) : points) * turn.transpose();
}

/// A surface of separate triangles: those that differ in red.
///
/// @param points  their corners come first
AnimatedMesh mesh_of(const Subject& subject, const std::vector<int>& shown,
                     const Positions& points) {
  AnimatedMesh mesh;
  mesh.weights.values = Eigen::MatrixXf::Zero(1, 0);
  for (const bool is_unlike : {false, true}) {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const bool differs =
          std::binary_search(subject.unlike.begin(), subject.unlike.end(), shown[i]);
      const auto row = static_cast<Eigen::Index>(3 * i);
      if (differs == is_unlike) rows.insert(rows.end(), {row, row + 1, row + 2});
    }
    if (rows.empty()) continue;
    AnimatedPrimitive& primitive = mesh.primitives.emplace_back();
    primitive.positions = points(rows, Eigen::all).cast<float>();
    primitive.triangles.resize(static_cast<Eigen::Index>(rows.size() / 3), 3);
    std::iota(primitive.triangles.data(), primitive.triangles.data() + primitive.triangles.size(),
              0);
    primitive.base_colour = is_unlike ? kRed : kGrey;
  }
  return mesh;
}

/// Draws the sides of the first triangles, unless they are too dense to be told apart.
///
/// @param points  three a triangle, and more
void draw_sides(std::size_t triangles, const std::vector<SeenPoint>& points, Image& picture) {
  double length = 0;
  std::vector<std::pair<Eigen::Vector2f, Eigen::Vector2f>> lines;
  for (std::size_t c = 0; c < 3 * triangles; ++c) {
    const SeenPoint& from = points[c];
    const SeenPoint& to = points[c % 3 == 2 ? c - 2 : c + 1];
    if (from.is_hidden || to.is_hidden) continue;
    length += (to.pixel - from.pixel).norm();
    lines.emplace_back(from.pixel, to.pixel);
  }
  if (length < kShortestEdge * static_cast<double>(lines.size())) return;
  for (const auto& [from, to] : lines) draw_line(picture, from, to, 1, kEdge);
}

/// Some triangles of a source, and rings around the places.
Image picture_of(const Subject& subject, const std::vector<int>& shown, const Eigen::Matrix3d& turn,
                 const BakeOptions& options) {
  TurntableOptions look = options.turntable;
  look.threads = options.threads;
  look.width = look.height = kCell;
  look.frames = 1;
  look.orbit = look.azimuth = look.elevation = 0;
  if (shown.empty()) return blank_image(kCell, kCell, {236, 235, 232});
  const Positions points = points_of(subject, shown, turn);
  StillView view = render_still(mesh_of(subject, shown, points), look, points);
  draw_sides(shown.size(), view.points, view.picture);
  for (std::size_t i = 3 * shown.size(); i < view.points.size(); ++i) {
    const SeenPoint& at = view.points[i];
    if (!at.is_hidden) draw_ring(view.picture, at.pixel, 24, 27, kRing);
  }
  return std::move(view.picture);
}

std::vector<int> all_triangles(const SourceMesh& source) {
  std::vector<int> all(static_cast<std::size_t>(source.triangles.rows()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Length of the longest side of a triangle, times kReach.
double reach_around(const SourceMesh& source, const Spot& spot) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const double side =
        (corner(source, spot.triangle, k) - corner(source, spot.triangle, (k + 1) % 3)).norm();
    longest = std::max(longest, side);
  }
  return kReach * longest;
}

std::vector<int> triangles_near(const SourceMesh& source, const Spot& spot) {
  const double reach = reach_around(source, spot);
  std::vector<int> near;
  for (int f = 0; f < source.triangles.rows(); ++f) {
    const Eigen::RowVector3d middle =
        (corner(source, f, 0) + corner(source, f, 1) + corner(source, f, 2)) / 3;
    if ((middle - spot.position).norm() < reach) near.push_back(f);
  }
  return near;
}

/// Whether a close picture shows more than that of the whole.
bool is_worth_a_closer_look(const Subject& subject) {
  if (!subject.first) return false;
  const double across = 2 * reach_around(subject.source, *subject.first);
  return across > 0 && across < bounding_diagonal(subject.source.positions) / 2;
}

void draw_title(const std::string& title, Image& picture) {
  draw_text(picture, title, {12, 12}, 2, kText);
}

}  // namespace

Image mismatch_picture(const SourceMesh& first, const SourceMesh& other,
                       const TopologyMismatch& mismatch, const BakeOptions& options,
                       const Observer& observer) {
  const MismatchPlace& place = mismatch.places.front();
  Subject left{first, mismatch.first_triangles, {}, place.first};
  Subject right{other, mismatch.other_triangles, {}, place.other};
  for (const MismatchPlace& each : mismatch.places) {
    if (each.first) left.spots.push_back(*each.first);
    if (each.other) right.spots.push_back(*each.other);
  }
  const bool has_close = is_worth_a_closer_look(left) && is_worth_a_closer_look(right);
  std::vector<Image> whole, close;
  for (const Subject* subject : {&left, &right}) {
    stop_if_cancelled(observer);
    const Subject& seen_from = subject->first ? *subject : subject == &left ? right : left;
    const Eigen::Matrix3d turn = facing(normal_around(seen_from));
    const SourceMesh& source = subject->source;
    whole.push_back(picture_of(*subject, all_triangles(source), turn, options));
    draw_title(fmt::format("{}: {} triangles, {} differ", source.name, source.triangles.rows(),
                           subject->unlike.size()),
               whole.back());
    if (!has_close) continue;
    close.push_back(picture_of(*subject, triangles_near(source, *subject->first), turn, options));
    draw_title("close to the first place", close.back());
  }
  whole.insert(whole.end(), std::make_move_iterator(close.begin()),
               std::make_move_iterator(close.end()));
  return contact_sheet(whole, 2, kCell);
}

}  // namespace morphbake
