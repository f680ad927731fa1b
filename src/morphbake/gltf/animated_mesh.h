#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/gltf/gltf_file.h"
#include "morphbake/gltf/mesh_choice.h"

namespace morphbake {

using Float2s = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Float3s = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using TriangleIndices = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

enum class Interpolation { Linear, Step, CubicSpline };

/// Numbers that change in time: an animation's sampler (glTF 2.0, 3.11).
struct AnimationCurve {
  std::vector<float> times;  ///< seconds, rising; empty: the first row of values stands
  Eigen::MatrixXf values;    ///< #times (1 without any) by #numbers
  Interpolation interpolation = Interpolation::Linear;
  Eigen::MatrixXf in_tangents;   ///< as values for CubicSpline, else empty: a second
  Eigen::MatrixXf out_tangents;  ///< likewise
};

/// The numbers at `time`: constant before the first key and after the last.
Eigen::VectorXd value_at(const AnimationCurve& curve, double time);

/// One glTF primitive as a viewer sees it, in mesh space.
struct AnimatedPrimitive {
  TriangleIndices triangles;    ///< #F by 3, indices into the rows below
  Float3s positions;            ///< #V by 3
  Float3s normals;              ///< #V by 3, or no rows: flat shading
  Float3s colours;              ///< #V by 3 linear RGB (COLOR_0), or no rows: white
  Float2s texture_coordinates;  ///< #V by 2 (the base-colour texture's set), or no rows
  Eigen::Vector3f base_colour = Eigen::Vector3f::Ones();  ///< linear RGB factor of the material
  int image = -1;  ///< base-colour texture: index into AnimatedMesh::images, -1 for none
  std::vector<Float3s> target_positions;  ///< one a target: #V by 3 displacement, or no rows
  std::vector<Float3s> target_normals;    ///< one a target: #V by 3 displacement, or no rows
  std::vector<Float3s> target_colours;    ///< one a target: #V by 3 differences, or no rows
};

/// A node's mesh with its morph targets and their weights animation: what a viewer plays.
struct AnimatedMesh {
  int node = 0;  ///< of the file
  std::vector<AnimatedPrimitive> primitives;
  Eigen::Matrix4d to_scene = Eigen::Matrix4d::Identity();  ///< global transform of the node
  std::vector<std::string> target_names;  ///< one a target, "" when the file names none
  std::vector<std::string> images;        ///< encoded bytes (PNG, JPEG) of the images that are used
  std::vector<std::string> image_names;   ///< one an image, for messages: "a.glb#/images/0"
  AnimationCurve weights;  ///< one number a target; without animation the weights at rest
};

/// Reads a node's mesh from a .glb or .gltf, with its targets and an animation of their weights.
/// Skins are at rest: the mesh is as it was bound.
///
/// @param choice     which node: none chosen is the first of the scene that has a mesh
/// @param animation  none chosen is the last one that moves the node's weights
/// @throws BakeError "gltf...." as open_gltf, choose_mesh_node and read_source_geometry;
///         "gltf.no-such-animation", also for one that moves no weights of the node
AnimatedMesh read_animated_mesh(const std::filesystem::path& file, const MeshChoice& choice = {},
                                const NameOrIndex& animation = {});
AnimatedMesh read_animated_mesh(const GltfFile& file, const MeshChoice& choice = {},
                                const NameOrIndex& animation = {});

/// What one animation of a file does to the weights of a node.
struct WeightsAnimation {
  int index = 0;  ///< of the file
  std::string name;
  std::size_t keys = 0;
  double duration = 0;  ///< seconds: its last key
};

/// All animations that move the weights of a node, in the file's order.
///
/// @throws BakeError "gltf.invalid", "gltf.accessor"
std::vector<WeightsAnimation> weights_animations(const GltfFile& file, int node);

/// What write_morph_glb() wrote.
struct WrittenMesh {
  AnimatedMesh mesh;                  ///< with the last clip's weights
  std::vector<AnimationCurve> clips;  ///< one number a target; one at least: the weights at rest
};

/// Reads back what write_morph_glb() wrote, as read_animated_mesh() does. Its size is that of what
/// was asked for: the limits for files of others do not hold.
///
/// @param name  what messages call it
/// @param clips  how many animations at the end are its own; without any it shows the weights at
///               rest
WrittenMesh read_written_mesh(const std::string& glb, const std::filesystem::path& name, int node,
                              std::size_t clips);

/// Weights at `time`: linear between keys, constant before the first and after the last.
///
/// @param times    seconds, rising; without any the first row stands
/// @param weights  #keys (1 without times) by #targets
/// @return         #targets
Eigen::VectorXd interpolate_keys(const std::vector<float>& times, const Eigen::MatrixXf& weights,
                                 double time);

/// The weights of `mesh` at `time`.
Eigen::VectorXd weights_at(const AnimatedMesh& mesh, double time);

}  // namespace morphbake
