#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/gltf_file.h"
#include "morphbake/gltf/mesh_choice.h"
#include "morphbake/profile/profile.h"

namespace morphbake {

/// How bad a finding is.
enum class FindingSeverity {
  Note,     ///< legal and read right; worth knowing
  Warning,  ///< legal, but it costs something or looks like a mistake
  Error     ///< against glTF 2.0, or read wrong by the profile's client
};

/// "note", "warning" or "error".
const char* name_of(FindingSeverity severity);

/// What a lint looks for. docs/profiles.md lists all of them.
struct LintRule {
  const char* code;  ///< "too-many-targets"
  FindingSeverity severity = FindingSeverity::Error;
  const char* meaning;
};

/// All rules, in the order in which they are checked.
std::vector<LintRule> lint_rules();

/// One thing that was found: of many alike in a mesh the first, with their number in the message.
struct Finding {
  FindingSeverity severity = FindingSeverity::Error;
  std::string rule;
  std::string pointer;  ///< into the glTF: "/meshes/0/primitives/0/targets/3/NORMAL"
  std::string message;
  std::string right;  ///< what would be right

  bool operator==(const Finding&) const = default;
};

/// What targets take on the GPU with one client.
struct GpuMemory {
  std::string profile;
  double bytes = 0;
};

/// Facts about a mesh that no rule judges.
struct LintedMesh {
  std::string node_pointer;
  std::string node_name;
  int primitives = 0;
  Eigen::Index vertices = 0;
  int targets = 0;
  bool has_normals = false;        ///< any target has NORMAL
  int most_active = 0;             ///< targets with weights other than 0 at one time
  double most_active_time = 0;     ///< seconds
  Eigen::AlignedBox3d rest;        ///< in the scene, without morphing
  Eigen::AlignedBox3d motion;      ///< in the scene, over all animations of the weights
  int motion_poses = 0;            ///< how many the motion was taken from
  bool is_motion_sampled = false;  ///< there were more than could be looked at
  std::vector<GpuMemory> gpu;      ///< by each shipped profile that knows, in their order
};

struct LintReport {
  std::string file;
  std::string profile;
  std::vector<LintedMesh> meshes;
  std::vector<Finding> findings;  ///< mesh by mesh, in the order of the rules
};

struct LintOptions {
  bool must_loop = false;  ///< a clip whose last key is not its first is an error
};

/// Compares a file with what a client reads. The file need not be one of ours.
///
/// @param choice  a node; without one all meshes with morph targets are looked at
/// @throws BakeError "gltf...." where the file cannot be read
LintReport lint(const GltfFile& file, const Profile& profile, const MeshChoice& choice = {},
                const LintOptions& options = {}, const Observer& observer = {});

/// What the targets of a mesh take on the GPU with each profile that knows it.
std::vector<GpuMemory> gpu_memory(const std::vector<Profile>& profiles, const AnimatedMesh& mesh);

/// The number of findings of that severity.
int count(const LintReport& report, FindingSeverity severity);

/// The report as JSON text: schemas/lint.schema.json.
std::string lint_to_json(const LintReport& report);

}  // namespace morphbake
