#pragma once

#include "morphbake/diagnostics/observer.h"
#include "morphbake/linear/eigenvectors.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Which eigenvectors of the Laplacian are kept, by rising frequency over the whole mesh: index 0
/// is the first. Those of #components constants are the lowest.
struct Band {
  int first = 0;
  int last = 0;  ///< kept as well
};

struct BandOptions {
  /// A cut above at most so many eigenvectors is exact, by these; beyond it is a filter. On meshes
  /// of up to 1000 vertices every cut is exact.
  int exact_limit = 300;
  /// Half width of a filter's cut, as a share of its frequency sqrt(lambda): an eigenvector that is
  /// further from it is kept, or removed, to 1e-4. Smaller is sharper and slower.
  double transition = 0.1;
  /// Largest degree of a filter, a pass over the mesh each. A cut at low frequencies that would
  /// need more has a transition in proportion wider.
  int max_degree = 2000;
};

/// The shape without what lies outside of a band of its spectrum.
///
/// Coordinates are projected to the band's part of the Deg-orthogonal basis. The constants stay in
/// any case: each component keeps its mean (weighted by degree), else all pieces of a band above
/// them would collapse into the origin. What passes is the source minus what lies above the band
/// and below it, so that the whole spectrum is the source itself, to the last bit.
///
/// A cut at up to BandOptions::exact_limit eigenvectors (fewer on meshes of more than 500k
/// vertices: they must fit into memory) is exact. A filter is a Chebyshev polynomial of L: a step
/// smoothed by the error function in acos(1 - lambda), at a frequency that SpectrumCount finds. An
/// exact cut through an eigenvalue that occurs several times is moved up behind all of it: which of
/// its vectors came first would be chance.
///
/// @return #V by 3
/// @throws BakeError "derive.band-out-of-range" at /first or /last, "linear.no-eigenvectors";
///         Cancelled
/// @see    Alexa 2003, section 5.1
Positions band_limited(const Mesh& mesh, const Band& band, const BandOptions& options = {},
                       const Observer& observer = {});

/// The part of columns in the first `count` vectors of a basis: U U^T Deg times them.
///
/// @param degrees  spectral_degrees
/// @param columns  #V by any number
Eigen::MatrixXd projected(const SpectralBasis& basis, const Eigen::VectorXd& degrees, int count,
                          const Eigen::MatrixXd& columns);

}  // namespace morphbake
