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
#include "morphbake/gltf/mesh_survey.h"
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
  morph.replaces_base = !source.is_at_rest;
  morph.drops_skin = source.is_posed;
  morph.target_names = {"still"};
  morph.clips = {{"still", {0, 1}, Eigen::MatrixXf::Zero(2, 1)}};
  return morph;
}

/// The ways in which a recipe may choose a shape of a file.
std::vector<MeshChoice> choices() {
  MeshChoice first_node, first_mesh, first_target, moment;
  first_node.node = 0;
  first_mesh.mesh = 0;
  first_target.target = 0;
  moment.moment = Moment{{}, 0.5};
  return {{}, first_node, first_mesh, first_target, moment};
}

void read_as_source(const GltfFile& file, const MeshChoice& choice, bool is_playable) {
  const SourceMesh source = read_source("source", file, choice);
  SourceRef ref;
  ref.name = "source";
  ref.file = file_of(file);
  succeeds([&] { source_surface(source, ref, {}); });
  succeeds([&] { share_connectivity({source, source}); });
  const std::string written = write_morph_glb(file, still_morph(source.geometry), "fuzz");
  GltfFile again;
  must_succeed("what was written does not open",
               [&] { again = open_gltf_bytes(written, "written.glb"); });
  MeshChoice same_node;
  same_node.node = source.geometry.node;
  must_succeed("what was written is no source", [&] { read_source("again", again, same_node); });
  if (!is_playable) return;
  must_succeed("what was written does not play", [&] { read_animated_mesh(again, same_node); });
}

void read_all(const std::string& bytes, const std::filesystem::path& name) {
  const GltfFile file = open_gltf_bytes(bytes, name);
  succeeds([&] { survey_meshes(file); });
  for (const MeshChoice& choice : choices()) {
    const bool is_playable = succeeds([&] { read_animated_mesh(file, choice); });
    succeeds([&] { read_as_source(file, choice, is_playable); });
  }
}

}  // namespace
}  // namespace morphbake::fuzz

// NOLINTNEXTLINE: libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace morphbake::fuzz;
  static const FuzzFolder folder;
  static const std::filesystem::path beside = folder.write("beside.bin", std::string(256, '\0'));
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  succeeds([&] { read_all(bytes, beside.parent_path() / "input.glb"); });
  return 0;
}
