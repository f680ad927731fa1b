#pragma once

// Internal to gltf/: the samplers of animations (glTF 2.0, 3.11 and appendix C).

#include <Eigen/Geometry>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/document.h"

namespace morphbake {

/// @throws BakeError "gltf.invalid" where there is none
const tinygltf::AnimationSampler& animation_sampler(const GltfDocument& document, int animation,
                                                    int sampler);

/// The first channel of an animation that moves the weights of `node`, or none.
const tinygltf::AnimationChannel* weights_channel(const tinygltf::Animation& animation, int node);

/// The numbers of a sampler.
///
/// @param columns  numbers a key
/// @throws BakeError "gltf.invalid", "gltf.accessor", "gltf.not-finite"
AnimationCurve read_curve(const GltfDocument& document, int animation, int sampler, int columns);

/// A rotation at `time`, of a curve with four columns x, y, z, w.
Eigen::Quaterniond rotation_at(const AnimationCurve& curve, double time);

}  // namespace morphbake
