#pragma once

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The points x with normal . x = offset; the normal may have any length but 0.
struct MirrorPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double offset = 0;
};

/// The mirror image of a shape on the same connectivity: what the left side did, the right does.
///
/// Vertices keep their side; each takes the mirrored position of the point that lies across:
/// V'_i = sum_k b_k M V_tri(k), where (tri, b) is the point of a symmetric `reference` that is
/// closest to M r_i, and M mirrors at the plane (through normal and offset, in the reference's
/// space, which must be that of the shape). Where a vertex lies within 1e-6 of the diagonal it is
/// taken itself, so that symmetric meshes are mirrored exactly; of several there (a closed mouth)
/// the one whose neighbours lie across as well.
///
/// @param reference  #V by 3, a symmetric geometry of the same connectivity
/// @return           #V by 3
/// @throws BakeError "derive.not-symmetric" when a point across is further than 2 % of the diagonal
///         from the reference's surface, "derive.no-direction"; Cancelled
Positions mirrored(const Mesh& mesh, const MirrorPlane& plane, const Positions& reference,
                   const Observer& observer = {});

/// As above with the shape itself as the reference.
Positions mirrored(const Mesh& mesh, const MirrorPlane& plane, const Observer& observer = {});

}  // namespace morphbake
