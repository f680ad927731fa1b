#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/gltf/gltf_file.h"

namespace morphbake {

using Float2s = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Float3s = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using TriangleIndices = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

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
};

/// A node's mesh with its morph targets and their weights animation: what a viewer plays.
struct AnimatedMesh {
  std::vector<AnimatedPrimitive> primitives;
  Eigen::Matrix4d to_scene = Eigen::Matrix4d::Identity();  ///< global transform of the node
  std::vector<std::string> target_names;  ///< one a target, "" when the file names none
  std::vector<std::string> images;        ///< encoded bytes (PNG, JPEG) of the images that are used
  std::vector<std::string> image_names;   ///< one an image, for messages: "a.glb#/images/0"
  std::vector<float> key_times;           ///< seconds, rising; empty without animation
  Eigen::MatrixXf
      key_weights;  ///< #keys (one row of rest weights without animation) by #targets, LINEAR
};

/// Reads the first node with a mesh from a .glb or .gltf, with targets and weights animation.
///
/// @throws BakeError "gltf...." as read_gltf
AnimatedMesh read_animated_mesh(const std::filesystem::path& file);
AnimatedMesh read_animated_mesh(const GltfFile& file);

/// Weights at `time`: linear between keys, constant before the first and after the last
/// (glTF 2.0, 3.11).
///
/// @param times    seconds, rising; without any the first row stands
/// @param weights  #keys (1 without times) by #targets
/// @return         #targets
Eigen::VectorXd interpolate_keys(const std::vector<float>& times, const Eigen::MatrixXf& weights,
                                 double time);

/// The weights of `mesh` at `time`.
Eigen::VectorXd weights_at(const AnimatedMesh& mesh, double time);

}  // namespace morphbake
