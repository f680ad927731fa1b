#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace morphbake {

/// How it is known what a client reads.
enum class Evidence {
  Client,        ///< the tests run that version of it on what morphbake writes
  Documentation  ///< from its documentation and sources only
};

/// Which sparse accessors a client reads right.
enum class SparseSupport { None, WithView, Any };

/// How a mesh with its targets is written.
enum class Encoding {
  Float,      ///< 32-bit floats
  Sparse,     ///< likewise, of targets of which few vertices move only those
  Quantized,  ///< 16-bit integers (KHR_mesh_quantization), sparse likewise
  Meshopt     ///< integers as coarse as bounds allow, compressed (EXT_meshopt_compression)
};

/// What a client reads of morph targets: a file of config/profiles, or one of the user's own. Its
/// fields have the same names there, and schemas/profile.schema.json explains them.
struct Profile {
  std::string name;   ///< the file's, without .json: "web-three"
  std::string title;  ///< "three.js"
  Evidence evidence = Evidence::Documentation;
  std::string client;                ///< what was run or read
  std::string version;               ///< of the client, or ""
  std::vector<std::string> sources;  ///< where what stands here comes from

  std::optional<int> most_targets;               ///< of a mesh; none: no limit is known
  std::optional<int> most_targets_with_normals;  ///< where targets have NORMAL
  std::optional<int> most_active;                ///< with weights other than 0 at one time

  SparseSupport sparse = SparseSupport::Any;
  bool sparse_over_shared_view = true;  ///< several sparse accessors over the same numbers
  bool accessors_of_zeros = true;       ///< neither bufferView nor sparse
  bool mesh_quantization = false;       ///< KHR_mesh_quantization
  bool meshopt_compression = false;     ///< EXT_meshopt_compression

  std::vector<std::string> interpolations = {"LINEAR", "STEP", "CUBICSPLINE"};  ///< of weights
  bool clamps_weights = false;                                                  ///< to [0, 1]
  bool empty_names = true;         ///< targets may be called ""
  std::optional<int> name_bytes;   ///< of a target's name
  std::string forbidden_in_names;  ///< characters

  std::optional<int> gpu_bytes;               ///< a vertex and target
  std::optional<int> gpu_bytes_with_normals;  ///< likewise, where targets have NORMAL

  Encoding encoding = Encoding::Float;
};

/// "float", "sparse", "quantized" or "meshopt".
std::string name_of(Encoding encoding);

/// @param name  one of those
Encoding encoding_named(const std::string& name);

/// Whether the client reads files in an encoding. Sparse accessors are written without a view.
bool allows(const Profile& profile, Encoding encoding);

/// Reads a profile.
///
/// @param name_or_file  the name of a shipped one, "web-three", or the path of a .json file
/// @throws BakeError "profile.unknown-name"; "profile...." where it breaks its schema, with file
///         and JSON pointer; "files.missing", ..., "json.syntax", ...
Profile read_profile(const std::string& name_or_file);

/// The names of the shipped profiles, sorted.
std::vector<std::string> profile_names();

/// The shipped profiles, sorted by name.
std::vector<Profile> shipped_profiles();

/// A profile as the JSON text of its file.
std::string profile_to_json(const Profile& profile);

/// Most targets of a mesh, with NORMAL or without; none: no limit is known.
std::optional<int> most_targets(const Profile& profile, bool with_normals);

/// Vertices times targets, summed over the primitives of a mesh.
struct TargetVertices {
  double plain = 0;
  double with_normals = 0;  ///< of primitives whose targets have NORMAL
};

/// What the targets of a mesh take on the GPU, in bytes; none where it is not known.
std::optional<double> gpu_bytes(const Profile& profile, const TargetVertices& rows);

}  // namespace morphbake
