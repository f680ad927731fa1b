// Until the branch that writes map_to_sphere and triangulate is merged: delete this file then.
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/diagnostics/problem.h"

namespace morphbake {

std::vector<SphericalMap> map_to_sphere(const std::vector<SourceSurface>&, const Observer&) {
  throw BakeError(Problem{Severity::Error, "connectivity.empty", {}, "no remeshing yet", ""});
}

SharedTriangulation triangulate(const std::vector<SphericalMap>&, const RemeshOptions&,
                                const Observer&) {
  throw BakeError(Problem{Severity::Error, "connectivity.empty", {}, "no remeshing yet", ""});
}

}  // namespace morphbake
