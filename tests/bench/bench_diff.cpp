// Comparing two morphs of 240 frames, beside reading all bytes of both.

#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "bench/timing.h"
#include "morphbake/diff/file_difference.h"
#include "morphbake/files/files.h"
#include "morphbake/gltf/write_mesh.h"
#include "morphbake/gltf/write_morph.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 240;
constexpr int kShapes = 15;

/// A motion of a torus: smooth fields whose weights go up and down in time.
struct Motion {
  Mesh torus;
  std::vector<Float3s> fields;  ///< kShapes of them
  Eigen::MatrixXf weights;      ///< kFrames by kShapes, 0 in the first frame
};

Motion motion_of(int vertices) {
  const int side = static_cast<int>(std::sqrt(vertices / 2.0));
  Motion motion{test::torus(2 * side, side), {}, Eigen::MatrixXf(kFrames, kShapes)};
  for (int k = 0; k < kShapes; ++k) {
    const Positions bent = test::bent(motion.torus.positions, 0.1, static_cast<unsigned>(k + 1));
    motion.fields.push_back((bent - motion.torus.positions).cast<float>());
    for (int f = 0; f < kFrames; ++f) {
      motion.weights(f, k) =
          static_cast<float>(std::pow(std::sin(3.14159 * f * (k + 1) / kFrames), 2));
    }
  }
  return motion;
}

MeshMorph empty_morph(const Motion& motion) {
  MeshMorph morph;
  const Float3s positions = motion.torus.positions.cast<float>();
  const Float3s normals = motion.torus.positions.rowwise().normalized().cast<float>();
  morph.primitives.push_back({positions, normals, {}, {}});
  MorphClip clip{"bench", {}, {}};
  for (int f = 0; f < kFrames; ++f) clip.key_times.push_back(static_cast<float>(f) / 30);
  morph.clips.push_back(clip);
  return morph;
}

void add_target(const Float3s& displacement, MeshMorph& morph) {
  morph.target_names.push_back(fmt::format("t{}", morph.target_names.size()));
  morph.primitives[0].target_positions.push_back(displacement);
  morph.primitives[0].target_normals.push_back(displacement * 0.3F);
}

/// All 15 shapes are active at once.
MeshMorph by_shapes(const Motion& motion) {
  MeshMorph morph = empty_morph(motion);
  for (const Float3s& field : motion.fields) add_target(field, morph);
  morph.clips[0].key_weights = motion.weights;
  return morph;
}

/// One target a frame, two of which are active at once.
MeshMorph by_frames(const Motion& motion) {
  MeshMorph morph = empty_morph(motion);
  for (int f = 1; f < kFrames; ++f) {
    Float3s displacement = Float3s::Zero(motion.fields[0].rows(), 3);
    for (int k = 0; k < kShapes; ++k) {
      displacement += motion.weights(f, k) * motion.fields[static_cast<std::size_t>(k)];
    }
    add_target(displacement, morph);
  }
  morph.clips[0].key_weights = Eigen::MatrixXf::Zero(kFrames, kFrames - 1);
  morph.clips[0].key_weights.bottomRows(kFrames - 1).setIdentity();
  return morph;
}

/// The same but for the last bits of all numbers, as another machine would bake it.
MeshMorph shaken(MeshMorph morph) {
  for (Float3s& target : morph.primitives[0].target_positions) target *= 1 + 3e-7F;
  for (Float3s& target : morph.primitives[0].target_normals) target *= 1 + 3e-7F;
  return morph;
}

fs::path write(const Motion& motion, const MeshMorph& morph, const fs::path& file) {
  PlainMesh plain;
  plain.name = "torus";
  plain.triangles = motion.torus.triangles;
  plain.positions = morph.primitives[0].positions;
  plain.normals = morph.primitives[0].normals;
  const GltfFile source = open_gltf_bytes(write_mesh_glb(plain, "bench"), "torus");
  PendingOutputs outputs;
  outputs.stage(file, write_morph_glb(source, morph, "bench"));
  outputs.commit();
  return file;
}

void time_diff(const std::string& name, const std::string& group, const fs::path& a,
               const fs::path& b, Figures& figures) {
  bool is_judged_same = true;
  const Pair pair = time_pair(
      3,
      [&] {
        read_file(a, fs::file_size(a));
        read_file(b, fs::file_size(b));
      },
      [&] { is_judged_same = is_judged_same && is_same(diff_files(a, b, {}, {})); });
  const std::string note = is_judged_same ? "same" : "different";
  const double megabytes = static_cast<double>(fs::file_size(a) + fs::file_size(b)) / 1e6;
  figures.push_back({group, name, pair.second, "s", note});
  figures.push_back({group, name + ", reading the bytes", pair.first, "s",
                     fmt::format("{:.0f} MB, from the page cache", megabytes)});
  figures.push_back({group, name + " / reading", pair.ratio, "x", "pairs"});
}

}  // namespace

void bench_diff(int vertices, Figures& figures) {
  const std::string group =
      fmt::format("diff, {} vertices, {} frames", shown_count(vertices), kFrames);
  const fs::path folder = fs::temp_directory_path() / "morphbake-bench-diff";
  fs::create_directories(folder);
  const Motion motion = motion_of(vertices);
  const fs::path frames = write(motion, by_frames(motion), folder / "frames.glb");
  const fs::path shapes = write(motion, by_shapes(motion), folder / "shapes.glb");
  time_diff("a target a frame, twice", group, frames,
            write(motion, shaken(by_frames(motion)), folder / "frames2.glb"), figures);
  time_diff("15 targets, twice", group, shapes,
            write(motion, shaken(by_shapes(motion)), folder / "shapes2.glb"), figures);
  time_diff("15 targets against a target a frame", group, shapes, frames, figures);
  fs::remove_all(folder);
}

}  // namespace morphbake::bench
