#include "morphbake/bake/region_pictures.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "morphbake/images/drawing.h"
#include "morphbake/images/srgb.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/normals.h"
#include "morphbake/preview/still_view.h"

namespace morphbake {
namespace {

constexpr int kCell = 400;  // pixels of a picture
constexpr int kColumns = 3;
constexpr int kMoreWidth = 160;  // of "and 12 more"
constexpr Ink kText = {{70, 66, 62}, 1};

using Colours = Float3s;  // #V by 3, linear RGB

// The colours of sources, told apart by colour-blind people too (Okabe and Ito 2008), sRGB.
constexpr std::array<std::array<std::uint8_t, 3>, 7> kSourceColours = {{{86, 180, 233},
                                                                        {230, 120, 0},
                                                                        {0, 158, 115},
                                                                        {204, 121, 167},
                                                                        {240, 228, 66},
                                                                        {0, 90, 160},
                                                                        {150, 60, 20}}};

/// The next seven are the same, darker, and so on.
std::array<std::uint8_t, 3> source_colour(std::size_t source) {
  std::array<std::uint8_t, 3> colour = kSourceColours[source % kSourceColours.size()];
  const std::size_t round = source / kSourceColours.size();
  for (std::uint8_t& channel : colour) {
    channel = static_cast<std::uint8_t>(channel * std::pow(0.6, static_cast<double>(round)));
  }
  return colour;
}

Eigen::RowVector3f linear(const std::array<std::uint8_t, 3>& srgb) {
  return {srgb_to_linear(srgb[0]), srgb_to_linear(srgb[1]), srgb_to_linear(srgb[2])};
}

/// The surface in given colours, about the origin and of size 1: the numbers of a picture are
/// floats.
AnimatedMesh painted(const Positions& positions, const Triangles& triangles, Colours colours) {
  const Eigen::RowVector3d low = positions.colwise().minCoeff();
  const Eigen::RowVector3d high = positions.colwise().maxCoeff();
  const double diagonal = (high - low).norm();
  const Positions centred =
      (positions.rowwise() - (low + high) / 2) / (diagonal > 0 ? diagonal : 1);
  AnimatedMesh mesh;
  mesh.weights.values = Eigen::MatrixXf::Zero(1, 0);
  AnimatedPrimitive& primitive = mesh.primitives.emplace_back();
  primitive.positions = centred.cast<float>();
  primitive.triangles = triangles;
  primitive.normals = smooth_normals(centred, triangles).cast<float>();
  primitive.colours = std::move(colours);
  return mesh;
}

Image cell(const AnimatedMesh& mesh, double azimuth, const std::string& title,
           const BakeOptions& options) {
  TurntableOptions look = options.turntable;
  look.threads = options.threads;
  look.width = look.height = kCell;
  look.frames = 1;
  look.orbit = 0;
  look.azimuth = azimuth;
  Image picture = render_still(mesh, look, {}).picture;
  draw_text(picture, title, {12, 12}, 2, kText);
  return picture;
}

struct HeatColours {
  Eigen::RowVector3f inside, middle, outside;  // linear
};

const HeatColours kHeat = {{0.62F, 0.02F, 0.02F}, {0.80F, 0.55F, 0.08F}, {0.42F, 0.46F, 0.50F}};

/// Grey outside, yellow half-way, red inside.
Colours heat(const Eigen::VectorXd& d) {
  Colours colours(d.size(), 3);
  for (Eigen::Index v = 0; v < d.size(); ++v) {
    const auto share = static_cast<float>(d(v));
    colours.row(v) = share < 0.5F
                         ? (1 - 2 * share) * kHeat.inside + 2 * share * kHeat.middle
                         : (2 - 2 * share) * kHeat.middle + (2 * share - 1) * kHeat.outside;
  }
  return colours;
}

struct LegendEntry {
  std::array<std::uint8_t, 3> colour;  // sRGB
  std::string text;
};

void draw_legend(const std::vector<LegendEntry>& entries, Image& sheet) {
  int left = 14;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const int width = text_size(entries[i].text, 2).x() + 44;
    const bool is_last = i + 1 == entries.size();
    if (left + width + (is_last ? 0 : kMoreWidth) > sheet.width) {
      const std::string more = fmt::format("and {} more", entries.size() - i);
      draw_text(sheet, more, {left, sheet.height - 27}, 2, kText);
      break;
    }
    const auto middle = static_cast<float>(sheet.height - 20);
    draw_ring(sheet, {static_cast<float>(left) + 8, middle}, 0, 8, {entries[i].colour, 1});
    draw_text(sheet, entries[i].text, {left + 22, sheet.height - 27}, 2, kText);
    left += width;
  }
}

std::array<std::uint8_t, 3> srgb(const Eigen::RowVector3f& colour) {
  return {linear_to_srgb(colour(0)), linear_to_srgb(colour(1)), linear_to_srgb(colour(2))};
}

/// Degrees around Y from which most of the inside is seen.
double azimuth_of(const Positions& positions, const Triangles& triangles, const Eigen::VectorXd& d,
                  double otherwise) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const Eigen::Vector3d a = positions.row(triangles(f, 0)), b = positions.row(triangles(f, 1)),
                          c = positions.row(triangles(f, 2));
    double inside = 0;
    for (int k = 0; k < 3; ++k) inside += (1 - d(triangles(f, k))) / 3;
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    sum += inside * normal;
    area += inside * normal.norm();
  }
  const double around = std::hypot(sum.x(), sum.z());
  // What goes all around, or faces up or down, is seen from everywhere alike.
  if (!(around > 0.15 * area)) return otherwise;
  return std::atan2(sum.x(), sum.z()) * 180 / M_PI + 20;  // a little aside shows its form
}

/// The shape on which a region is shown: that on which it is measured, the first for others.
int shown_on(const RegionOfInterest& region) {
  return std::visit(
      [](const auto& shape) {
        if constexpr (requires { shape.source; }) {
          return shape.source;
        } else {
          return 0;
        }
      },
      region.shape);
}

}  // namespace

Image region_sheet(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                   const BakeOptions& options, const Observer& observer) {
  std::vector<Image> cells;
  const Triangles& triangles = mesh.connectivity.triangles;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    stop_if_cancelled(observer);
    const RegionField& field = regions[r];
    const Positions& positions =
        mesh.geometries[static_cast<std::size_t>(shown_on(recipe.regions[r]))];
    const bool changes = field.moves || field.floods;
    for (const double way : changes ? std::vector{0.25, 0.5, 0.75} : std::vector{1.0}) {
      const RegionMoment moment{field.moves ? way * recipe.timeline.duration : 0,
                                field.floods ? way : 1};
      const Eigen::VectorXd d = distance_at(regions, static_cast<int>(r), moment);
      std::string when = field.moves ? fmt::format(" {:.2f} s", moment.time) : "";
      if (field.floods) when += fmt::format(" {:.0f} %", 100 * way);
      const double azimuth = changes
                                 ? options.turntable.azimuth
                                 : azimuth_of(positions, triangles, d, options.turntable.azimuth);
      cells.push_back(cell(painted(positions, triangles, heat(d)), azimuth,
                           recipe.regions[r].name + when, options));
    }
  }
  Image sheet = contact_sheet(cells, std::min(kColumns, static_cast<int>(cells.size())), kCell);
  draw_legend(
      {{srgb(kHeat.inside), "all"}, {srgb(kHeat.middle), "half"}, {srgb(kHeat.outside), "none"}},
      sheet);
  return sheet;
}

namespace {

/// The colours of the sources mixed by the vertices' shares; shares an axis are averaged.
Colours mixed_colours(const TransitionState& T, Eigen::Index count) {
  Colours colours = Colours::Zero(count, 3);
  const Eigen::Index blocks = T.cols() / count;
  for (Eigen::Index s = 0; s < T.rows(); ++s) {
    const Eigen::RowVector3f colour = linear(source_colour(static_cast<std::size_t>(s)));
    for (Eigen::Index block = 0; block < blocks; ++block) {
      const Eigen::VectorXf share =
          T.row(s).segment(block * count, count).transpose().cast<float>();
      colours += share.cwiseMax(0).cwiseMin(1) * colour / static_cast<float>(blocks);
    }
  }
  return colours.cwiseMin(1);
}

std::vector<LegendEntry> legend_of(const MorphableMesh& mesh) {
  std::vector<LegendEntry> entries;
  for (std::size_t s = 0; s < mesh.names.size(); ++s) {
    entries.push_back({source_colour(s), mesh.names[s]});
  }
  return entries;
}

}  // namespace

Image share_sheet(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                  const SolvedTimeline& timeline, const BakeOptions& options) {
  constexpr int kMoments = 6;
  std::vector<Image> cells;
  const Eigen::Index count = mesh.connectivity.vertex_count;
  for (int i = 0; i < kMoments; ++i) {
    const double time = recipe.timeline.duration * i / (kMoments - 1);
    const Positions positions = position_at(recipe, mesh, regions, timeline, time);
    const TransitionState T = transition_at(recipe, regions, count, time);
    cells.push_back(cell(painted(positions, mesh.connectivity.triangles, mixed_colours(T, count)),
                         options.turntable.azimuth, fmt::format("{:.2f} s", time), options));
  }
  Image sheet = contact_sheet(cells, kColumns, kCell);
  draw_legend(legend_of(mesh), sheet);
  return sheet;
}

}  // namespace morphbake
