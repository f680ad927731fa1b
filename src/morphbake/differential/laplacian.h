#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Differential (Laplacian) coordinates: every vertex relative to the mean of its neighbours.
///
/// @return  W = L V with L = I - Deg^-1 A: #V by 3
/// @see     Alexa 2003, section 4.1, eq. 2 and 3
Positions differential_coordinates(const OneRings& rings, const Positions& positions);

/// The symmetric form of the Laplacian, K_L = Deg - A = Deg L: #V by #V, positive semi-definite,
/// with the constants on each connected component as its null space.
Eigen::SparseMatrix<double> symmetric_laplacian(const OneRings& rings);

/// Those with a weight other than 0 somewhere, rising: the others add nothing to any sum.
///
/// @param weights  #sources by any number
std::vector<Eigen::Index> sources_with_weights(const Eigen::MatrixXd& weights);

/// Right-hand side of K_L V' = b that blends the sources' differences along edges:
///
///   b_i = sum_j sum_s (T_s,i + T_s,j) / 2 (v_s,i - v_s,j)   over the neighbours j of i
///
/// Each edge adds to one end what it takes from the other, so b sums to 0 over every component and
/// the system is solvable exactly, for any T; fixing one vertex instead (section 4.3 of the paper)
/// throws the imbalance into it. For constant T it is Deg times the sum of eq. 6. Linear in T.
/// @param geometries  one a source: #V by 3
/// @param weights     #sources by #V: row s is the diagonal of T_s; or by 3 #V, one T_s an axis
/// @return            b: #V by 3
/// @see               Alexa 2003, eq. 6; docs/method.md
Positions blend_edge_differences(const OneRings& rings, const std::vector<Positions>& geometries,
                                 const Eigen::MatrixXd& weights);

/// Right-hand side that blends differential coordinates at vertices, eq. 6 of the paper times the
/// degree:
///
///   b_i = deg_i sum_s T_s,i w_s,i
///
/// Where T varies in space it does not sum to 0: the system has no solution until it is balanced.
/// @param geometries  one a source: #V by 3
/// @param weights     #sources by #V, or 3 #V likewise
/// @return            b: #V by 3
/// @see               Alexa 2003, eq. 6
Positions blend_vertex_differences(const OneRings& rings, const std::vector<Positions>& geometries,
                                   const Eigen::MatrixXd& weights);

}  // namespace morphbake
