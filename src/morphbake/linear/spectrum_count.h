#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/linear/shifted_factor.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {

/// A frequency, and how many eigenvalues lie below it in each component.
struct Enclosure {
  double lambda = 0;
  std::vector<int> counts;

  int total() const;
};

/// How many eigenvalues of S = Deg^-1/2 K_L Deg^-1/2 lie below a number, exactly: the inertia of
/// K_L - lambda Deg. All lie in [0, 2].
class SpectrumCount {
 public:
  explicit SpectrumCount(const OneRings& rings);

  int vertex_count() const { return static_cast<int>(components_.label.size()); }

  const Components& components() const { return components_; }

  /// @return with the lambda that was taken, see ShiftedFactor::factorise
  /// @throws BakeError "linear.no-eigenvectors"
  /// @cost   a sparse factorisation: 0.3 s at 50k vertices
  Enclosure below(double lambda);

  /// Finds a frequency with `fewest` to `most` eigenvalues below it, by bisection.
  ///
  /// On a surface eigenvalues grow in proportion to their index (Weyl's law), so the first guesses
  /// are close. Where there is no such frequency, since many eigenvalues are equal, it is right
  /// above one with more.
  /// @param fewest     1 to #V
  /// @param precision  relative width at which the search may end with more than `most`
  Enclosure enclose(int fewest, int most, double precision, const Observer& observer);

 private:
  Components components_;
  ShiftedFactor factor_;
};

}  // namespace morphbake
