#pragma once

#include <Eigen/Core>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/linear/eigenvectors.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {

/// Eigenpairs of S = Deg^-1/2 K_L Deg^-1/2, orthonormal.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Deg^1/2, normalised: the eigenvector of S to the eigenvalue 0 of one component.
Eigen::VectorXd constant_eigenvector(const OneRings& rings);

/// All `count` eigenpairs below `lambda`, the constant first, of a mesh of one component.
///
/// Spectrum slicing: the inertia cuts [0, lambda] into slices of some twenty pairs, and of each
/// Spectra finds those nearest to its middle, in shift-invert mode. Of one slice over all pairs,
/// keeping the iteration's vectors orthogonal would cost most (#V count^2), and more solves would
/// be needed. Slices are solved on several threads, with the same bytes whatever their number.
///
/// @param lambda  right above an eigenvalue it may be too low by 1e-9, relative
/// @throws BakeError "linear.no-eigenvectors"; Cancelled
/// @cost  three to six solves a pair, each kept orthogonal to its slice; two factorisations a slice
/// @see   Parlett, The Symmetric Eigenvalue Problem, chapter 3 (slicing the spectrum)
Eigenpairs eigenpairs_below(const OneRings& rings, double lambda, int count,
                            const EigenvectorOptions& options, const Observer& observer);

}  // namespace morphbake
