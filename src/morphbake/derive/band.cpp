#include "morphbake/derive/band.h"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/linear/spectrum_count.h"

namespace morphbake {
namespace {

constexpr int kExactVertices = 1000;     ///< every cut is exact up to this size
constexpr double kLargestBasis = 1.5e8;  ///< numbers of an exact one: 1.2 GB
constexpr double kStepWidth = 2.63;      ///< erfc(x) / 2 is 1e-4 there
constexpr double kTruncation = 4.29;     ///< exp(-x^2) is 1e-8 there
constexpr double kCutPrecision = 0.05;   ///< of a cut's frequency, as a share of its transition
constexpr int kPassesPerCheck = 16;

void require_inside(const Band& band, Eigen::Index vertex_count) {
  if (band.first >= 0 && band.first <= band.last && band.last < vertex_count) return;
  const bool is_first = band.first < 0 || band.first >= vertex_count || band.first > band.last;
  throw BakeError(Problem{
      Severity::Error,
      "derive.band-out-of-range",
      {"", is_first ? "/first" : "/last", 0, 0},
      fmt::format("the band {} to {} of a mesh with {} eigenvectors", band.first, band.last,
                  vertex_count),
      fmt::format("first may not be larger than last; both go from 0 to {}", vertex_count - 1)});
}

/// Each vertex's row: the mean of its component, weighted by degree.
Positions component_means(const Components& components, const Eigen::VectorXd& degrees,
                          const Positions& positions) {
  Positions sums = Positions::Zero(components.count, 3);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(components.count);
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    const int component = components.label[static_cast<std::size_t>(v)];
    sums.row(component) += degrees(v) * positions.row(v);
    weights(component) += degrees(v);
  }
  const Positions means = weights.cwiseInverse().asDiagonal() * sums;
  return means(components.label, Eigen::all);
}

/// Deg^-1 A times columns: every row becomes the mean of its neighbours'.
Positions neighbour_means(const OneRings& rings, const Positions& columns) {
  Positions means(columns.rows(), 3);
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    const auto v = static_cast<std::size_t>(i);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      sum += columns.row(rings.neighbours[static_cast<std::size_t>(n)]);
    }
    const int degree = rings.degree(static_cast<int>(i));
    if (degree > 0) {
      means.row(i) = sum / degree;
    } else {
      means.row(i) = columns.row(i);
    }
  }
  return means;
}

/// A step in theta = acos(1 - lambda), the angle at which Chebyshev polynomials are cosines.
struct Filter {
  double cut = 0;    ///< theta
  double width = 0;  ///< the step is erfc((theta - cut) / width) / 2
  int degree = 0;

  /// Fourier's: those of a sharp step, damped as the Gaussian that smooths it.
  double coefficient(int k) const {
    if (k == 0) return cut / std::numbers::pi;
    const double damping = std::exp(-std::pow(k * width / 2, 2));
    return 2 * std::sin(k * cut) / (std::numbers::pi * k) * damping;
  }
};

Filter filter_at(double lambda, const BandOptions& options) {
  const double cut = std::acos(std::clamp(1 - lambda, -1.0, 1.0));
  const double wished = options.transition * cut / kStepWidth;
  const double width = std::max(wished, 2 * kTruncation / std::max(1, options.max_degree));
  return {cut, width, static_cast<int>(std::ceil(2 * kTruncation / width))};
}

/// p(L) times columns by the recurrence of Chebyshev polynomials of I - L.
Positions apply(const Filter& filter, const OneRings& rings, const Positions& columns,
                const Observer& observer) {
  Positions previous = columns;
  Positions current = neighbour_means(rings, columns);
  Positions sum = filter.coefficient(0) * previous + filter.coefficient(1) * current;
  for (int k = 2; k <= filter.degree; ++k) {
    if (k % kPassesPerCheck == 0) stop_if_cancelled(observer);
    previous = 2 * neighbour_means(rings, current) - previous;
    previous.swap(current);
    sum += filter.coefficient(k) * current;
  }
  return sum;
}

/// Splits a shape, without its components' means, into low and high frequencies.
class Splitter {
 public:
  Splitter(const OneRings& rings, const Mesh& mesh, const BandOptions& options,
           const Observer& observer)
      : rings_(rings), options_(options), observer_(observer) {
    const Components components = connected_components(rings);
    constant_count_ = components.count;
    shape_ = mesh.positions - component_means(components, spectral_degrees(rings), mesh.positions);
  }

  /// The shape without the means.
  const Positions& shape() const { return shape_; }

  /// The shape's part in the first `count` eigenvectors, of which it has none of the constants.
  Positions below(int count) const {
    if (count <= constant_count_) return Positions::Zero(shape_.rows(), 3);
    if (count >= shape_.rows()) return shape_;
    return is_exact(count) ? by_eigenvectors(count) : by_filter(count);
  }

  /// Computes the eigenvectors of the larger of two exact cuts, once for both.
  void prepare(int first_count, int second_count) {
    int largest = constant_count_;
    for (const int count : {first_count, second_count}) {
      if (count < shape_.rows() && is_exact(count)) largest = std::max(largest, count);
    }
    if (largest > constant_count_) basis_ = smallest_eigenvectors(rings_, largest, {}, observer_);
  }

 private:
  bool is_exact(int count) const {
    if (shape_.rows() <= kExactVertices) return true;
    return count <= options_.exact_limit &&
           static_cast<double>(count) * static_cast<double>(shape_.rows()) <= kLargestBasis;
  }

  Positions by_eigenvectors(int count) const {
    return projected(basis_, spectral_degrees(rings_), whole_count(basis_, count), shape_);
  }

  Positions by_filter(int count) const {
    SpectrumCount spectrum(rings_);
    const double precision = kCutPrecision * options_.transition;
    const double cut = spectrum.enclose(count, count, precision, observer_).lambda;
    return apply(filter_at(cut, options_), rings_, shape_, observer_);
  }

  const OneRings& rings_;
  BandOptions options_;
  const Observer& observer_;
  int constant_count_ = 0;
  Positions shape_;
  SpectralBasis basis_;
};

}  // namespace

Eigen::MatrixXd projected(const SpectralBasis& basis, const Eigen::VectorXd& degrees, int count,
                          const Eigen::MatrixXd& columns) {
  assert(count <= basis.vectors.cols());
  const auto vectors = basis.vectors.leftCols(count);
  const Eigen::MatrixXd amplitudes = vectors.transpose() * (degrees.asDiagonal() * columns);
  return vectors * amplitudes;
}

Positions band_limited(const Mesh& mesh, const Band& band, const BandOptions& options,
                       const Observer& observer) {
  require_inside(band, mesh.positions.rows());
  const OneRings rings = one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
  Splitter splitter(rings, mesh, options, observer);
  splitter.prepare(band.first, band.last + 1);
  const Positions above = splitter.shape() - splitter.below(band.last + 1);
  return mesh.positions - above - splitter.below(band.first);
}

}  // namespace morphbake
