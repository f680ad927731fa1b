#pragma once

// Internal to gltf/: checked reads of accessors. Nothing is allocated before the sizes were
// checked.

#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/document.h"

namespace morphbake {

/// Bytes of a number of `componentType`; 0 of none.
std::size_t component_bytes(int type);

/// Numbers an element of `type` has: "SCALAR", "VEC2" to "VEC4", "MAT2" to "MAT4".
std::size_t components_of(const std::string& type);

/// Elements of an accessor.
/// @throws BakeError "gltf.accessor" when it does not exist
std::size_t accessor_count(const GltfDocument& document, int accessor, const std::string& pointer);

/// Numbers an element of the accessor has: 1 for SCALAR to 16 for MAT4.
int accessor_columns(const GltfDocument& document, int accessor, const std::string& pointer);

/// @param vertices  that a primitive has: each of its attributes has as many elements
/// @throws BakeError "gltf.accessor"
void check_count(const GltfDocument& document, int accessor, std::size_t vertices,
                 const std::string& pointer);

/// The accessor's elements of `columns` numbers each, row by row: floats, or integers, which become
/// fractions when they are normalised (glTF 2.0, 3.6.2.2). Sparse elements are put in; without a
/// bufferView the others are 0.
///
/// @param pointer  the place that names the accessor, for messages
/// @throws BakeError "gltf.accessor" out of range or of another kind, "gltf.too-large",
///         "gltf.not-finite"
std::vector<float> read_floats(const GltfDocument& document, int accessor, int columns,
                               const std::string& pointer);

/// As read_floats, of VEC2 and VEC3 elements.
Float2s read_float2s(const GltfDocument& document, int accessor, const std::string& pointer);
Float3s read_float3s(const GltfDocument& document, int accessor, const std::string& pointer);

/// Elements of an accessor of unsigned SCALARs, which are all there.
///
/// @throws BakeError "gltf.accessor", "gltf.too-large"
std::size_t index_count(const GltfDocument& document, int accessor, const std::string& pointer);

/// The numbers of vertices in an accessor of indices.
///
/// @param vertices  each is less
/// @param out       index_count of them
/// @throws BakeError "gltf.accessor"
void read_indices(const GltfDocument& document, int accessor, std::size_t vertices,
                  const std::string& pointer, std::span<int> out);

/// VEC4 of unsigned numbers: JOINTS_n, row by row.
///
/// @throws BakeError "gltf.accessor", "gltf.too-large"
std::vector<std::uint32_t> read_joints(const GltfDocument& document, int accessor,
                                       const std::string& pointer);

}  // namespace morphbake
