#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/gltf_file.h"

namespace morphbake {

enum class MorphedAttribute { Position, Normal };

/// One attribute of one target of one primitive.
struct TargetPlace {
  std::size_t primitive = 0;
  std::size_t target = 0;
  MorphedAttribute attribute = MorphedAttribute::Position;
};

struct TargetSource;

/// The displacements of a mesh's morph targets, read in parts from where they are.
///
/// Safe to be read by several threads at once.
class TargetRows {
 public:
  /// Of a mesh without targets.
  TargetRows() = default;

  /// Those of a file, which is kept open. All numbers are looked at once.
  ///
  /// @throws BakeError "gltf.accessor", "gltf.not-finite", "gltf.too-large"; of several the first
  ///         in the file's order
  TargetRows(const GltfFile& file, int mesh);

  /// Those of a mesh in memory, which must outlive it.
  explicit TargetRows(const AnimatedMesh& mesh);

  std::size_t count() const { return count_; }

  /// Whether the target has that attribute.
  bool has(const TargetPlace& place) const;

  /// Bounds of a target's displacements of positions; empty where it has none.
  const Eigen::AlignedBox3f& bounds(std::size_t primitive, std::size_t target) const;

  /// Reads the displacements of `count` vertices from `begin` on.
  ///
  /// @param place  one that has()
  /// @param out    3 count numbers
  void read(const TargetPlace& place, Eigen::Index begin, Eigen::Index count, float* out) const;

 private:
  const TargetSource& source_at(const TargetPlace& place) const;

  GltfFile file_;  ///< none of a mesh in memory
  std::size_t count_ = 0;
  std::shared_ptr<const std::vector<TargetSource>>
      sources_;  ///< primitive by primitive, two a target
};

}  // namespace morphbake
