#pragma once

#include <memory>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {

/// Degrees as the spectrum takes them: a vertex without neighbours counts as 1, with eigenvalue 0.
Eigen::VectorXd spectral_degrees(const OneRings& rings);

/// A frequency, and how many eigenvalues lie below it in each component.
struct Enclosure {
  double lambda = 0;
  std::vector<int> counts;
};

/// How many eigenvalues of S = Deg^-1/2 K_L Deg^-1/2 lie below a number, exactly: Sylvester's law
/// of inertia on L D L^T = K_L - lambda Deg. All lie in [0, 2].
class SpectrumCount {
 public:
  explicit SpectrumCount(const OneRings& rings);
  ~SpectrumCount();
  SpectrumCount(const SpectrumCount&) = delete;
  SpectrumCount& operator=(const SpectrumCount&) = delete;

  int vertex_count() const;

  const Components& components() const;

  /// @param lambda  where a pivot vanishes (a regular mesh at 1), the count is taken up to 1e-4
  /// above
  /// @throws BakeError "linear.no-eigenvectors" when every try meets such a pivot
  /// @cost   a sparse factorisation: 0.7 s at 50k vertices
  int below(double lambda);

  /// As below, one a component.
  std::vector<int> below_by_component(double lambda);

  /// Finds a frequency with `fewest` to `most` eigenvalues below it, by bisection.
  ///
  /// On a surface eigenvalues grow in proportion to their index (Weyl's law), so the first guesses
  /// are close. Where there is no such frequency, since many eigenvalues are equal, it is right
  /// above one with more.
  /// @param fewest     1 to #V
  /// @param precision  relative width at which the search may end with more than `most`
  Enclosure enclose(int fewest, int most, double precision, const Observer& observer);

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// SpectrumCount::below once.
int eigenvalues_below(const OneRings& rings, double lambda);

}  // namespace morphbake
