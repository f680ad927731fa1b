#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/diff/diff_options.h"
#include "morphbake/diff/motion_difference.h"
#include "morphbake/gltf/animated_mesh.h"

namespace morphbake {

/// Something that is not the same in two files, or a note on what need not be.
struct Finding {
  bool is_difference = true;  ///< false: a note
  std::string kind;           ///< stable: "triangles", "bounds", ...; listed in docs/diff.md
  std::string message;        ///< for people, with what both files have
};

/// A clip that both files have: the weights at rest, or an animation of each.
struct ClipDifference {
  bool is_rest = false;
  std::string name_a;
  std::string name_b;
  MotionDifference motion;
};

/// How far apart may be what is the same, in the units of what is compared.
struct AllowedDifference {
  double distance = 0;                 ///< scene units
  std::optional<double> normal_angle;  ///< degrees; nothing where normals are not judged
};

/// A mesh that both files have.
struct MeshDifference {
  std::string name;
  int node_a = 0;
  int node_b = 0;
  double diagonal = 0;  ///< scene units, of the first file's first frame
  AllowedDifference allowed;
  std::vector<ClipDifference> clips;    ///< the weights at rest first
  std::vector<std::size_t> primitives;  ///< that could be compared vertex by vertex
  VertexDifferences vertices;           ///< of these, over all clips
  std::size_t vertices_beyond = 0;      ///< further than is allowed, at any time
  std::size_t normals_beyond = 0;       ///< turned further; 0 where normals are not judged
  std::vector<Finding> findings;
};

/// What diff_files found.
struct FileDifference {
  std::string file_a;
  std::string file_b;
  std::vector<MeshDifference> meshes;
  std::vector<Finding> findings;  ///< of the files as a whole
};

/// Whether no finding is a difference.
bool is_same(const FileDifference& difference);

/// Compares structure and meaning of two morph glTF files: of each mesh its triangles, attributes,
/// materials, names, bounds and animations, and its evaluated shape at every key of either file and
/// half-way between keys.
///
/// Meshes are paired by their nodes' names where both files have them once, else in the order of
/// the scene; animations likewise. Skins are at rest.
/// @throws BakeError with the problems of both files: as open_gltf and read_animated_mesh;
/// Cancelled
/// @cost   memory for both files as they are, and as floats
FileDifference diff_files(const std::filesystem::path& a, const std::filesystem::path& b,
                          const DiffOptions& options, const Observer& observer);

/// As JSON text: schemas/diff.schema.json.
std::string difference_json(const FileDifference& difference);

}  // namespace morphbake
