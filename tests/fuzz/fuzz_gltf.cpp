// Fuzz target: bytes of a .glb or .gltf, read in every way that a bake and a preview read them. Of
// a file that can be a source a morph is written; it must open again.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fuzz/fuzz_folder.h"
#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/write_morph.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake::fuzz {
namespace {

/// Whether `work` ended without a complaint. Any exception but BakeError is a find.
bool succeeds(const auto& work) {
  try {
    work();
    return true;
  } catch (const BakeError&) {
    return false;
  }
}

/// Stops unless `work` ends without a complaint.
void must_succeed(const char* what, const auto& work) {
  try {
    work();
  } catch (const BakeError& error) {
    std::fprintf(stderr, "%s: %s\n", what, error.what());
    std::abort();
  }
}

/// One target that moves nothing, and its animation.
MeshMorph still_morph(const SourceGeometry& source) {
  MeshMorph morph;
  morph.node = source.node;
  morph.mesh = source.mesh;
  for (const PrimitiveGeometry& primitive : source.primitives) {
    const Float3s zeros = Float3s::Zero(primitive.positions.rows(), 3);
    const bool has_normals = primitive.normals.rows() > 0;
    morph.primitives.push_back({primitive.positions,
                                primitive.normals,
                                {zeros},
                                has_normals ? std::vector{zeros} : std::vector<Float3s>{}});
  }
  morph.target_names = {"still"};
  morph.animation_name = "still";
  morph.key_times = {0, 1};
  morph.key_weights = Eigen::MatrixXf::Zero(2, 1);
  return morph;
}

void read_all(const std::string& bytes, const std::filesystem::path& name) {
  const GltfFile file = open_gltf_bytes(bytes, name);
  const bool is_playable = succeeds([&] { read_animated_mesh(file); });
  const SourceMesh source = read_source("source", file);
  SourceRef ref;
  ref.name = "source";
  ref.file = name;
  succeeds([&] { source_surface(source, ref, {}); });
  succeeds([&] { share_connectivity({source, source}); });
  const std::string written = write_morph_glb(file, still_morph(source.geometry), "fuzz");
  GltfFile again;
  must_succeed("what was written does not open",
               [&] { again = open_gltf_bytes(written, name.parent_path() / "written.glb"); });
  if (is_playable) {
    must_succeed("what was written does not play", [&] { read_animated_mesh(again); });
  }
}

}  // namespace
}  // namespace morphbake::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace morphbake::fuzz;
  static const FuzzFolder folder;
  static const std::filesystem::path beside = folder.write("beside.bin", std::string(256, '\0'));
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  succeeds([&] { read_all(bytes, beside.parent_path() / "input.glb"); });
  return 0;
}
