#include "morphbake/bake/connectivity_sheet.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "morphbake/connectivity/map_distortion.h"
#include "morphbake/images/drawing.h"
#include "morphbake/images/srgb.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/normals.h"
#include "morphbake/preview/still_view.h"
#include "morphbake/preview/turntable.h"

namespace morphbake {
namespace {

constexpr int kCell = 480;           // pixels of a picture
constexpr int kColumns = 4;          // source, new surface, checker, heat
constexpr int kCheckerCells = 16;    // along the longer side
constexpr int kCheckerPixels = 64;   // of a cell
constexpr double kShortestEdge = 4;  // pixels: shorter ones would only darken the picture
constexpr Ink kText = {{70, 66, 62}, 1};

/// Linear RGB of a hue (0 to 1) at a brightness.
std::array<float, 3> hue_colour(double hue, double brightness) {
  std::array<float, 3> colour{};
  for (int k = 0; k < 3; ++k) {
    const double wave = std::abs(std::fmod(hue * 6 + 2 * k, 6.0) - 3) - 1;
    colour[static_cast<std::size_t>(k)] =
        static_cast<float>(brightness * (0.15 + 0.85 * std::clamp(wave, 0.0, 1.0)));
  }
  return colour;
}

/// Columns of cells by hue, rows by brightness, so that a cell can be found on every source.
Image checker() {
  const int side = kCheckerCells * kCheckerPixels;
  Image image{side, side, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int column = x / kCheckerPixels, row = y / kCheckerPixels;
      const double brightness = (column + row) % 2 == 0 ? 0.75 : 0.22;
      for (const float part : hue_colour(1.0 * column / kCheckerCells, brightness)) {
        image.rgb.push_back(linear_to_srgb(part));
      }
    }
  }
  return image;
}

/// Texture coordinates: the first source's positions on the plane of its two largest extents.
Float2s checker_coordinates(const Positions& positions) {
  const Eigen::RowVector3d low = positions.colwise().minCoeff();
  const Eigen::RowVector3d extent = positions.colwise().maxCoeff() - low;
  std::array<Eigen::Index, 3> axes = {0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](auto a, auto b) { return extent(a) > extent(b); });
  std::sort(axes.begin(), axes.begin() + 2);
  Float2s coordinates(positions.rows(), 2);
  const double side = extent.maxCoeff();
  for (Eigen::Index k = 0; k < 2; ++k) {
    const Eigen::Index axis = axes[static_cast<std::size_t>(k)];
    coordinates.col(k) = ((positions.col(axis).array() - low(axis)) / side).cast<float>();
  }
  return coordinates;
}

/// Linear RGB from grey-white (1, an isometry) over yellow to red (5 and above).
Eigen::RowVector3f heat_colour(double distortion) {
  const double share = std::clamp(std::log(distortion) / std::log(kHighDistortion), 0.0, 1.0);
  const std::array<Eigen::RowVector3f, 4> stops = {
      Eigen::RowVector3f(0.62F, 0.62F, 0.6F), Eigen::RowVector3f(0.85F, 0.7F, 0.12F),
      Eigen::RowVector3f(0.85F, 0.25F, 0.03F), Eigen::RowVector3f(0.6F, 0.01F, 0.01F)};
  const double place = share * 3;
  const auto low = static_cast<std::size_t>(std::min(place, 2.0));
  const auto rest = static_cast<float>(place - static_cast<double>(low));
  return (1 - rest) * stops[low] + rest * stops[low + 1];
}

/// Colour of each vertex: the mean heat of the triangles around it, in logarithms.
Float3s heat_colours(const Eigen::VectorXd& distortion, const Connectivity& k) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(k.vertex_count), counts = sums;
  for (Eigen::Index f = 0; f < k.triangles.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      sums(k.triangles(f, c)) += std::log(std::min(distortion(f), 100.0));
      counts(k.triangles(f, c)) += 1;
    }
  }
  Float3s colours(k.vertex_count, 3);
  for (int v = 0; v < k.vertex_count; ++v) {
    colours.row(v) = heat_colour(std::exp(sums(v) / std::max(1.0, counts(v))));
  }
  return colours;
}

AnimatedMesh still_mesh(AnimatedPrimitive primitive) {
  AnimatedMesh mesh;
  mesh.primitives.push_back(std::move(primitive));
  mesh.weights.values = Eigen::MatrixXf::Zero(1, 0);
  return mesh;
}

AnimatedPrimitive smooth_surface(const Positions& positions, const Triangles& triangles) {
  std::vector<int> of_corner(triangles.data(), triangles.data() + triangles.size());
  AnimatedPrimitive primitive;
  primitive.triangles = triangles;
  primitive.positions = positions.cast<float>();
  primitive.normals =
      corner_group_normals(positions, triangles, of_corner, static_cast<int>(positions.rows()))
          .cast<float>();
  return primitive;
}

/// Heat of every source: the map to it, on the first the largest of all.
std::vector<Eigen::VectorXd> distortions(const SharedTriangulation& triangulation) {
  const Triangles& triangles = triangulation.connectivity.triangles;
  std::vector<Eigen::VectorXd> all = {Eigen::VectorXd::Ones(triangles.rows())};
  for (std::size_t s = 1; s < triangulation.geometries.size(); ++s) {
    all.push_back(
        map_distortion(triangulation.geometries[0], triangulation.geometries[s], triangles));
    all[0] = all[0].cwiseMax(all[s]);
  }
  return all;
}

TurntableOptions look_of(const BakeOptions& options) {
  TurntableOptions look = options.turntable;
  look.threads = options.threads;
  look.width = look.height = kCell;
  look.frames = 1;
  look.orbit = 0;
  return look;
}

Image picture_of(const AnimatedMesh& mesh, const BakeOptions& options) {
  return render_still(mesh, look_of(options), Positions(0, 3)).picture;
}

/// Every edge of K that is seen, unless they are too dense to be told apart.
void draw_edges(const Triangles& triangles, const std::vector<SeenPoint>& points, Image& picture) {
  double length = 0;
  std::vector<std::pair<int, int>> seen;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(f, k), b = triangles(f, (k + 1) % 3);
      const SeenPoint& from = points[static_cast<std::size_t>(a)];
      const SeenPoint& to = points[static_cast<std::size_t>(b)];
      if (a > b || from.is_hidden || to.is_hidden) continue;
      length += (to.pixel - from.pixel).norm();
      seen.emplace_back(a, b);
    }
  }
  if (seen.empty() || length / static_cast<double>(seen.size()) < kShortestEdge) return;
  for (const auto& [a, b] : seen) {
    draw_line(picture, points[static_cast<std::size_t>(a)].pixel,
              points[static_cast<std::size_t>(b)].pixel, 1, {{40, 30, 25}, 0.35F});
  }
}

/// The new triangles of one source, flat, with their edges and landmarks.
Image surface_picture(const SharedTriangulation& triangulation, std::size_t s,
                      const BakeOptions& options) {
  const Triangles& triangles = triangulation.connectivity.triangles;
  const Positions& positions = triangulation.geometries[s];
  AnimatedPrimitive flat;  // without normals every triangle is seen
  flat.triangles = triangles;
  flat.positions = positions.cast<float>();
  StillView view = render_still(still_mesh(std::move(flat)), look_of(options), positions);
  draw_edges(triangles, view.points, view.picture);
  for (const int landmark : triangulation.landmarks) {
    const SeenPoint& at = view.points[static_cast<std::size_t>(landmark)];
    if (at.is_hidden) continue;
    draw_ring(view.picture, at.pixel, 0, 4.5F, {{255, 255, 255}, 1});
    draw_ring(view.picture, at.pixel, 0, 3, {{200, 30, 40}, 1});
  }
  return std::move(view.picture);
}

/// What the colours of the last column mean, drawn into the corner of a picture.
void draw_legend(Image& picture) {
  constexpr int kWidth = 240, kHeight = 12, kLeft = 20;
  const int top = picture.height - 44;
  for (int x = 0; x < kWidth; ++x) {
    const double share = (x + 0.5) / kWidth;
    const Eigen::RowVector3f colour = heat_colour(std::pow(kHighDistortion, share));
    const std::array<std::uint8_t, 3> shown = {linear_to_srgb(colour(0)), linear_to_srgb(colour(1)),
                                               linear_to_srgb(colour(2))};
    paste(blank_image(1, kHeight, shown), kLeft + x, top, picture);
  }
  for (const char* number : {"1", "1.5", "2", "3", "5+"}) {
    const double value = number[1] == '.' ? 1.5 : number[0] - '0';
    const double share = std::log(value) / std::log(kHighDistortion);
    const int at = kLeft + static_cast<int>(std::lround(share * kWidth));
    const int left = at - text_size(number, 2).x() / 2;
    draw_text(picture, number, {left, top + kHeight + 5}, 2, kText);
  }
}

void draw_title(std::string_view title, Image& picture) {
  draw_text(picture, title, {12, 12}, 2, kText);
}

}  // namespace

Image connectivity_sheet(const std::vector<SourceMesh>& sources, const RemeshedSources& remeshed,
                         const BakeOptions& options, const Observer& observer) {
  const SharedTriangulation& triangulation = remeshed.triangulation;
  const Connectivity& k = triangulation.connectivity;
  const Float2s coordinates = checker_coordinates(triangulation.geometries[0]);
  const std::string checker_png = encode_png(checker());
  const std::vector<Eigen::VectorXd> heat = distortions(triangulation);
  std::vector<Image> pictures;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    advance(observer, {"sheet", static_cast<int>(s), static_cast<int>(sources.size())});
    pictures.push_back(picture_of(
        read_animated_mesh(sources[s].file, {.node = sources[s].geometry.node}), options));
    draw_title(sources[s].name, pictures.back());
    stop_if_cancelled(observer);
    pictures.push_back(surface_picture(triangulation, s, options));
    draw_title(fmt::format("{} vertices", k.vertex_count), pictures.back());
    stop_if_cancelled(observer);
    AnimatedPrimitive checked = smooth_surface(triangulation.geometries[s], k.triangles);
    checked.texture_coordinates = coordinates;
    checked.image = 0;
    AnimatedMesh with_checker = still_mesh(std::move(checked));
    with_checker.images = {checker_png};
    pictures.push_back(picture_of(with_checker, options));
    draw_title("equal cells: equal places", pictures.back());
    stop_if_cancelled(observer);
    AnimatedPrimitive heated = smooth_surface(triangulation.geometries[s], k.triangles);
    heated.colours = heat_colours(heat[s], k);
    pictures.push_back(picture_of(still_mesh(std::move(heated)), options));
    draw_title(s == 0 ? "distortion, largest" : "distortion from the first", pictures.back());
    draw_legend(pictures.back());
  }
  return contact_sheet(pictures, kColumns, kCell);
}

}  // namespace morphbake
