#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "morphbake/connectivity/mesh_health.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/mesh_choice.h"
#include "morphbake/lint/lint.h"

namespace morphbake::cli {

struct TargetFacts {
  std::string name;
  int moving_vertices = 0;
  double largest_displacement = 0;  ///< scene units
  double file_bytes = 0;            ///< of its accessors, compressed as they are
};

/// The weights of one animation, where a picture of them was asked for.
struct DrawnWeights {
  std::filesystem::path picture;
  std::string animation;  ///< its name, or ""
  AnimationCurve curve;   ///< one number a target
};

/// What `morphbake inspect` tells about a file.
struct InspectFacts {
  std::filesystem::path file;
  std::uintmax_t bytes = 0;
  int node = 0;
  std::size_t primitives = 0;
  Eigen::Index vertices = 0;
  Eigen::Index triangles = 0;
  std::vector<TargetFacts> targets;
  int moving_vertices = 0;  ///< by any target
  std::vector<WeightsAnimation> animations;
  Eigen::AlignedBox3d bounds;                ///< of the base shape in the scene
  std::vector<GpuMemory> gpu;                ///< of the targets
  std::variant<MeshHealth, Problem> health;  ///< or why the mesh can be no source
  std::optional<DrawnWeights> weights;
};

/// What is wanted besides the mesh of a node.
struct WeightsRequest {
  std::filesystem::path picture;  ///< empty: none
  NameOrIndex animation;          ///< none: the last one that moves the weights
};

/// @throws BakeError "gltf...."; "gltf.no-such-animation" also where none moves the weights
InspectFacts inspect_facts(const std::filesystem::path& file, const NameOrIndex& node,
                           const WeightsRequest& weights, const Observer& observer);

/// Of all targets, in mesh units.
double largest_displacement(const InspectFacts& facts);

/// The facts as JSON text.
std::string inspect_json(const InspectFacts& facts);

}  // namespace morphbake::cli
