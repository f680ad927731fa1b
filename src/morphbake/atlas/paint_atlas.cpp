#include "morphbake/atlas/paint_atlas.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "morphbake/atlas/fill_gaps.h"
#include "morphbake/images/srgb.h"
#include "morphbake/mesh/surface_point.h"

namespace morphbake {
namespace {

constexpr int kBandRows = 32;             // that are painted at a time, for little memory
constexpr std::size_t kBandsAtOnce = 16;  // between two words about the progress

/// A triangle on the picture, in texels.
struct FlatTriangle {
  Eigen::Matrix<double, 3, 2> corners;
  double width = 0;  ///< of a texel on the surface
};

FlatTriangle flat_triangle(const Atlas& atlas, const Mesh& mesh, int f) {
  FlatTriangle flat;
  Eigen::Matrix3d corners;
  const int* places = &atlas.of_corner[3 * static_cast<std::size_t>(f)];
  for (int k = 0; k < 3; ++k) {
    flat.corners.row(k) = atlas.places.row(places[k]) * atlas.size;
    corners.row(k) = mesh.positions.row(mesh.triangles(f, k));
  }
  const Eigen::RowVector2d a = flat.corners.row(1) - flat.corners.row(0);
  const Eigen::RowVector2d b = flat.corners.row(2) - flat.corners.row(0);
  const double texels = std::abs(a.x() * b.y() - a.y() * b.x());
  const Eigen::RowVector3d u = corners.row(1) - corners.row(0), v = corners.row(2) - corners.row(0);
  if (texels > 0) flat.width = std::sqrt(u.cross(v).norm() / texels);
  return flat;
}

/// Barycentric coordinates of the point of segment a, b that is nearest to `place`: the share of b.
double share_along(const Eigen::RowVector2d& a, const Eigen::RowVector2d& b,
                   const Eigen::RowVector2d& place) {
  const double length = (b - a).squaredNorm();
  return length > 0 ? std::clamp((place - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
}

/// Barycentric coordinates of the triangle's point that is nearest to `place`.
Eigen::Vector3d nearest_in(const FlatTriangle& flat, const Eigen::RowVector2d& place) {
  const auto cross = [&](int i, int j) {
    const Eigen::RowVector2d a = flat.corners.row(i) - place, b = flat.corners.row(j) - place;
    return a.x() * b.y() - a.y() * b.x();
  };
  const Eigen::Vector3d areas(cross(1, 2), cross(2, 0), cross(0, 1));
  const double all = areas.sum();
  if (all != 0 && (areas / all).minCoeff() >= 0) return areas / all;
  Eigen::Vector3d best(1, 0, 0);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double share = share_along(flat.corners.row(k), flat.corners.row(next), place);
    const Eigen::RowVector2d at =
        (1 - share) * flat.corners.row(k) + share * flat.corners.row(next);
    if ((at - place).squaredNorm() >= least) continue;
    least = (at - place).squaredNorm();
    best.setZero();
    best(k) = 1 - share;
    best(next) += share;
  }
  return best;
}

/// The triangles that come near each band of rows.
std::vector<std::vector<int>> triangles_of_bands(const Atlas& atlas,
                                                 const std::vector<FlatTriangle>& flat) {
  std::vector<std::vector<int>> bands(
      static_cast<std::size_t>((atlas.size + kBandRows - 1) / kBandRows));
  const int last_band = static_cast<int>(bands.size()) - 1;
  for (std::size_t f = 0; f < flat.size(); ++f) {
    const double low = flat[f].corners.col(1).minCoeff() - atlas.padding;
    const double high = flat[f].corners.col(1).maxCoeff() + atlas.padding;
    const int first = std::max(0, static_cast<int>(low) / kBandRows);
    const int last = std::min(last_band, static_cast<int>(high) / kBandRows);
    for (int b = first; b <= last; ++b) {
      bands[static_cast<std::size_t>(b)].push_back(static_cast<int>(f));
    }
  }
  return bands;
}

/// The nearest triangle of each texel of a band, as far as the padding goes.
struct Band {
  int first_row = 0;
  int rows = 0;
  std::vector<int> triangle;     ///< -1 where none is near
  std::vector<double> distance;  ///< squared, texels
};

Eigen::RowVector2d centre_of(int column, int row) { return {column + 0.5, row + 0.5}; }

void cover(const Atlas& atlas, const FlatTriangle& flat, int triangle, Band& band) {
  const Eigen::RowVector2d low = flat.corners.colwise().minCoeff().array() - atlas.padding - 0.5;
  const Eigen::RowVector2d high = flat.corners.colwise().maxCoeff().array() + atlas.padding - 0.5;
  const int left = std::max(0, static_cast<int>(std::ceil(low.x())));
  const int right = std::min(atlas.size - 1, static_cast<int>(std::floor(high.x())));
  const int top = std::max(band.first_row, static_cast<int>(std::ceil(low.y())));
  const int bottom =
      std::min(band.first_row + band.rows - 1, static_cast<int>(std::floor(high.y())));
  const double most = static_cast<double>(atlas.padding) * atlas.padding;
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      const Eigen::RowVector2d centre = centre_of(column, row);
      const double distance =
          (nearest_in(flat, centre).transpose() * flat.corners - centre).squaredNorm();
      const auto i =
          static_cast<std::size_t>(row - band.first_row) * static_cast<std::size_t>(atlas.size) +
          static_cast<std::size_t>(column);
      if (distance > most || distance >= band.distance[i]) continue;
      band.distance[i] = distance;
      band.triangle[i] = triangle;
    }
  }
}

/// The picture in the making.
struct Painting {
  const Atlas& atlas;
  std::vector<FlatTriangle> flat;  ///< #F
  Image image;
  std::vector<char> known;  ///< one a texel
};

void paint_row(const Band& band, int row, const TexelColours& colours, Painting& painting) {
  std::vector<AtlasTexel> texels;
  std::vector<std::size_t> pixels;
  const auto size = static_cast<std::size_t>(painting.atlas.size);
  for (int column = 0; column < painting.atlas.size; ++column) {
    const auto i =
        static_cast<std::size_t>(row - band.first_row) * size + static_cast<std::size_t>(column);
    if (band.triangle[i] < 0) continue;
    const FlatTriangle& triangle = painting.flat[static_cast<std::size_t>(band.triangle[i])];
    texels.push_back(
        {{band.triangle[i], nearest_in(triangle, centre_of(column, row))}, triangle.width});
    pixels.push_back(static_cast<std::size_t>(row) * size + static_cast<std::size_t>(column));
  }
  if (texels.empty()) return;
  const std::vector<Eigen::Array3f> found = colours(texels);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    painting.known[pixels[i]] = 1;
    std::uint8_t* rgb = &painting.image.rgb[3 * pixels[i]];
    for (int c = 0; c < 3; ++c) rgb[c] = linear_to_srgb(found[i](c));
  }
}

/// Texels of a band that nothing is near to yet.
Band empty_band(int number, int size) {
  Band band;
  band.first_row = number * kBandRows;
  band.rows = std::min(kBandRows, size - band.first_row);
  band.triangle.assign(static_cast<std::size_t>(band.rows) * static_cast<std::size_t>(size), -1);
  band.distance.assign(band.triangle.size(), std::numeric_limits<double>::infinity());
  return band;
}

/// @param triangles  that come near the band
void paint_band(int number, const std::vector<int>& triangles, const TexelColours& colours,
                Painting& painting) {
  Band band = empty_band(number, painting.atlas.size);
  for (const int f : triangles) {
    cover(painting.atlas, painting.flat[static_cast<std::size_t>(f)], f, band);
  }
  for (int row = band.first_row; row < band.first_row + band.rows; ++row) {
    paint_row(band, row, colours, painting);
  }
}

}  // namespace

Image paint_atlas(const Atlas& atlas, const Mesh& mesh, const TexelColours& colours,
                  const Observer& observer) {
  const auto texels = static_cast<std::size_t>(atlas.size) * static_cast<std::size_t>(atlas.size);
  Painting painting{atlas, {}, {atlas.size, atlas.size, {}}, std::vector<char>(texels, 0)};
  painting.image.rgb.resize(3 * texels);
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    painting.flat.push_back(flat_triangle(atlas, mesh, f));
  }
  const std::vector<std::vector<int>> bands = triangles_of_bands(atlas, painting.flat);
  for (std::size_t first = 0; first < bands.size(); first += kBandsAtOnce) {
    advance(observer, {"texture", static_cast<int>(first), static_cast<int>(bands.size())});
    const std::size_t last = std::min(bands.size(), first + kBandsAtOnce);
    tbb::parallel_for(first, last, [&](std::size_t b) {
      stop_if_cancelled(observer);
      paint_band(static_cast<int>(b), bands[b], colours, painting);
    });
  }
  fill_gaps(painting.image, painting.known);
  return std::move(painting.image);
}

}  // namespace morphbake
