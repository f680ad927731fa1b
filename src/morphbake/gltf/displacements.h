#pragma once

// Internal to gltf/: displacements of morph targets as accessors.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "morphbake/gltf/glb_draft.h"

namespace morphbake {

/// Rows that are not zero, rising.
std::vector<std::uint32_t> moving_rows(const Float3s& rows);

/// Appends some elements of an accessor; returns its field `sparse`.
///
/// @param moving  their indices, rising
/// @param values  tight
Json append_sparse_fields(GlbDraft& draft, const std::vector<std::uint32_t>& moving,
                          const void* values, std::size_t value_bytes);

/// Writes displacements of vertices, sparse where that is allowed and smaller.
class Displacements {
 public:
  /// @param draft  must outlive it
  Displacements(GlbDraft& draft, bool may_be_sparse)
      : draft_(draft), may_be_sparse_(may_be_sparse) {}

  /// Their accessor.
  int append(const Float3s& rows);

  /// The accessor of zeros of that many vertices, one for all targets.
  ///
  /// @param type  "VEC2" to "VEC4"
  int zeros(Eigen::Index vertices, const std::string& type);

 private:
  int append_sparse(const std::vector<std::uint32_t>& moving, const Float3s& rows);
  int append_zeros(Eigen::Index vertices, const std::string& type);

  GlbDraft& draft_;
  bool may_be_sparse_;
  std::map<std::pair<Eigen::Index, std::string>, int> zeros_;
};

}  // namespace morphbake
