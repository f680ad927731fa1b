#include "morphbake/diff/file_difference.h"

#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <set>

#include "morphbake/diff/heat_map.h"
#include "morphbake/files/temporary_folder.h"
#include "morphbake/gltf/write_mesh.h"
#include "morphbake/gltf/write_morph.h"
#include "morphbake/json/schema.h"
#include "unit/diff/moving_mesh.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

using testing::HasSubstr;

/// Files of one folder, made from meshes.
class FilesDiffer : public testing::Test {
 protected:
  /// @param change  of the .glb's JSON and bytes, done on its text
  fs::path write(const std::string& name, const AnimatedMesh& mesh, const PlainMesh& look = {}) {
    PlainMesh plain = look;
    plain.name = "sphere";
    plain.triangles = mesh.primitives[0].triangles;
    plain.positions = mesh.primitives[0].positions;
    plain.normals = mesh.primitives[0].normals;
    std::string bytes = write_mesh_glb(plain, "test");
    if (!mesh.target_names.empty()) bytes = with_targets(std::move(bytes), mesh);
    const fs::path file = folder_.path() / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }

  static std::string with_targets(std::string bytes, const AnimatedMesh& mesh) {
    MeshMorph morph;
    PrimitiveMorph& primitive = morph.primitives.emplace_back();
    primitive.positions = mesh.primitives[0].positions;
    primitive.normals = mesh.primitives[0].normals;
    primitive.target_positions = mesh.primitives[0].target_positions;
    for (const Float3s& target : primitive.target_positions) {
      primitive.target_normals.push_back(Float3s::Zero(target.rows(), 3));
    }
    morph.target_names = mesh.target_names;
    morph.clips = {{"go", mesh.weights.times, mesh.weights.values}};
    return write_morph_glb(open_gltf_bytes(std::move(bytes), "test"), morph, "test");
  }

  FileDifference diff(const AnimatedMesh& a, const AnimatedMesh& b,
                      const DiffOptions& options = {}) {
    return diff_files(write("a.glb", a), write("b.glb", b), options, {});
  }

  /// Replaces text in the JSON of a .glb by text of the same length.
  static void replace_in(const fs::path& file, const std::string& from, const std::string& to) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(in), {});
    const std::size_t at = bytes.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    ASSERT_EQ(from.size(), to.size());
    bytes.replace(at, from.size(), to);
    std::ofstream(file, std::ios::binary) << bytes;
  }

  TemporaryFolder folder_{"morphbake-test"};
};

/// "positions: difference", "targets: note", ... of all findings, each once.
std::set<std::string> kinds(const FileDifference& difference) {
  std::set<std::string> all;
  const auto add = [&](const std::vector<Finding>& findings) {
    for (const Finding& finding : findings) {
      all.insert(finding.kind + (finding.is_difference ? ": difference" : ": note"));
    }
  };
  add(difference.findings);
  for (const MeshDifference& mesh : difference.meshes) add(mesh.findings);
  return all;
}

using Kinds = std::set<std::string>;

TEST_F(FilesDiffer, TellsTheProblemsOfBothFiles) {
  std::ofstream(folder_.path() / "bad.glb") << "no glTF";
  try {
    diff_files(folder_.path() / "none.glb", folder_.path() / "bad.glb", {}, {});
    FAIL();
  } catch (const BakeError& error) {
    ASSERT_EQ(error.problems().size(), 2U);
    EXPECT_EQ(error.problems()[0].code, "files.missing");
    EXPECT_THAT(error.problems()[1].location.file, HasSubstr("bad.glb"));
  }
}

TEST_F(FilesDiffer, OfAFileFromItselfIsNothingAtAll) {
  const fs::path file = write("a.glb", by_frames(24));
  const FileDifference difference = diff_files(file, file, {.strict = true}, {});
  EXPECT_TRUE(is_same(difference));
  EXPECT_EQ(kinds(difference), Kinds{});
  ASSERT_EQ(difference.meshes.size(), 1U);
  ASSERT_EQ(difference.meshes[0].clips.size(), 2U);
  EXPECT_EQ(difference.meshes[0].clips[1].motion.instants, 47U);
  EXPECT_EQ(difference.meshes[0].clips[1].motion.position.value, 0);
}

TEST_F(FilesDiffer, OfAnotherBasisIsANoteUnlessItIsToBeTheSame) {
  const FileDifference difference = diff(by_frames(120), by_one_target(300));
  EXPECT_TRUE(is_same(difference));
  EXPECT_EQ(kinds(difference), (Kinds{"targets: note", "weights: note"}));
  const FileDifference strict = diff(by_frames(120), by_one_target(300), {.strict = true});
  EXPECT_FALSE(is_same(strict));
  EXPECT_TRUE(kinds(strict).contains("targets: difference"));
}

TEST_F(FilesDiffer, FindsOneVertexOfOneFrame) {
  const AnimatedMesh a = by_frames(120);
  AnimatedMesh b = a;
  b.primitives[0].target_positions[70](33, 1) += static_cast<float>(2e-5 * 3.4641016);
  const FileDifference difference = diff(a, b);
  EXPECT_EQ(kinds(difference), Kinds{"positions: difference"});
  EXPECT_EQ(difference.meshes[0].vertices_beyond, 1U);
  EXPECT_TRUE(is_same(diff(a, b, {.relative = 3e-5})));
  EXPECT_TRUE(is_same(diff(a, b, {.absolute = 1e-4})));
  EXPECT_FALSE(is_same(diff(a, b, {.absolute = 1e-7})));
  EXPECT_TRUE(is_same(diff(a, b, {.absolute = 1e-7, .relative = 3e-5}))) << "the larger one holds";
}

TEST_F(FilesDiffer, JudgesNormalsWhereTheWeightsAreTheSameOrTheAngleIsGiven) {
  const AnimatedMesh a = by_one_target(300);
  AnimatedMesh turned = a, frames = by_frames(120);
  turned.primitives[0].normals.row(3) = Eigen::RowVector3f::UnitX();
  frames.primitives[0].normals = turned.primitives[0].normals;
  EXPECT_EQ(kinds(diff(a, turned)), Kinds{"normals: difference"});
  EXPECT_EQ(kinds(diff(a, frames)), (Kinds{"normals: note", "targets: note", "weights: note"}));
  EXPECT_FALSE(is_same(diff(a, frames, {.normal_angle = 1})));
  EXPECT_TRUE(is_same(diff(a, frames, {.normal_angle = 170})));
}

TEST_F(FilesDiffer, TellsWhatMeshesAreMadeOf) {
  const AnimatedMesh a = still_sphere();
  AnimatedMesh turned = a;
  turned.primitives[0].triangles.row(4).reverseInPlace();
  EXPECT_EQ(kinds(diff(a, turned)), Kinds{"triangles: difference"});
  AnimatedMesh reordered = a;
  reordered.primitives[0].triangles.colwise().reverseInPlace();
  EXPECT_EQ(kinds(diff(a, reordered)), Kinds{"triangle-order: note"});
  AnimatedMesh larger = a;
  for (Float3s* rows : {&larger.primitives[0].positions, &larger.primitives[0].normals}) {
    rows->conservativeResize(rows->rows() + 1, Eigen::NoChange);
    rows->bottomRows(1) << 0, 0, 1;
  }
  EXPECT_EQ(kinds(diff(a, larger)), Kinds{"vertices: difference"});
}

TEST_F(FilesDiffer, TellsColoursAndMaterials) {
  const AnimatedMesh mesh = still_sphere();
  PlainMesh look;
  look.colours = Float3s::Constant(mesh.primitives[0].positions.rows(), 3, 0.5F);
  look.material = PlainMaterial{"skin", {1, 1, 1}, 1, 1, false};
  const fs::path a = write("a.glb", mesh, look);
  PlainMesh other = look;
  other.colours(7, 1) = 0.501F;
  other.material->name = "hide";
  other.material->roughness = 0.5;
  const fs::path b = write("b.glb", mesh, other);
  EXPECT_EQ(kinds(diff_files(a, b, {}, {})),
            (Kinds{"attribute-values: difference", "material: difference",
                   "material-values: difference"}));
  EXPECT_EQ(kinds(diff_files(a, b, {.attribute = 0.6}, {})), Kinds{"material: difference"});
  EXPECT_EQ(kinds(diff_files(a, write("c.glb", mesh), {}, {})),
            (Kinds{"attributes: difference", "material: difference"}));
}

TEST_F(FilesDiffer, TellsAnimationsByNameAndDuration) {
  const AnimatedMesh mesh = by_one_target(300);
  const fs::path a = write("a.glb", mesh), b = write("b.glb", mesh);
  replace_in(b, "\"name\":\"go\"", "\"name\":\"GO\"");
  EXPECT_EQ(kinds(diff_files(a, b, {}, {})), Kinds{"animations: difference"});
  AnimatedMesh longer = mesh;
  longer.weights.times.back() += 0.01F;
  EXPECT_TRUE(kinds(diff(mesh, longer)).contains("duration: difference"));
  EXPECT_TRUE(kinds(diff(mesh, still_sphere())).contains("animations: difference"));
}

TEST_F(FilesDiffer, ChecksBoundsAgainstTheNumbers) {
  const AnimatedMesh mesh = still_sphere();
  const fs::path a = write("a.glb", mesh), b = write("b.glb", mesh);
  replace_in(b, "\"min\":[-1.0,", "\"min\":[-1.1,");
  EXPECT_EQ(kinds(diff_files(a, b, {}, {})), Kinds{"bounds: difference"});
  EXPECT_EQ(kinds(diff_files(b, a, {}, {})), Kinds{"bounds: difference"});
  EXPECT_EQ(kinds(diff_files(b, b, {}, {})), Kinds{"bounds: note"}) << "both state the same";
}

TEST_F(FilesDiffer, AsJsonFitsItsSchemaAndFillsAllOfIt) {
  AnimatedMesh a = by_frames(24), b = by_one_target(100);
  b.primitives[0].positions.row(3) *= 2;
  b.primitives[0].normals.row(3) = Eigen::RowVector3f::UnitX();
  FileDifference difference = diff(a, b, {.normal_angle = 1});
  difference.findings.push_back({true, "meshes", "one more"});
  const Json json = parse_json(difference_json(difference), "diff");
  std::string said;
  for (const Problem& problem :
       schema_problems(json, shipped_schema("diff.schema.json"), {"diff", ""})) {
    said += format_problem(problem) + "\n";
  }
  EXPECT_EQ(said, "");
  EXPECT_FALSE(json["same"].get<bool>());
  EXPECT_TRUE(json["meshes"][0]["clips"][1].contains("normal"));
  EXPECT_TRUE(json["meshes"][0]["allowed"].contains("normal_angle"));
}

TEST(HeatColour, RisesFromGreyOverBlueToRed) {
  EXPECT_EQ(heat_colour(0), Eigen::Vector3f(0.6F, 0.6F, 0.6F));
  EXPECT_GT(heat_colour(1).z(), heat_colour(1).x());
  EXPECT_GT(heat_colour(1.001).y(), 0.7F);
  EXPECT_LT(heat_colour(1e3).y(), 0.01F);
  EXPECT_EQ(heat_colour(1e9), heat_colour(std::numeric_limits<double>::infinity()));
}

TEST_F(FilesDiffer, HeatMapColoursWhatDiffers) {
  const AnimatedMesh a = by_one_target(100);
  AnimatedMesh b = a;
  b.primitives[0].positions(9, 0) += 0.5F;
  const FileDifference difference = diff(a, b);
  const AnimatedMesh heat = heat_mesh(difference, worst_mesh(difference));
  const Float3s& colours = heat.primitives[0].colours;
  for (Eigen::Index v = 0; v < colours.rows(); ++v) {
    EXPECT_EQ(colours.row(v).x() > 0.7F, v == 9) << v;
  }
  const std::string glb = heat_map_glb(difference);
  const AnimatedMesh written = read_animated_mesh(open_gltf_bytes(glb, "heat.glb"));
  EXPECT_EQ(written.primitives[0].colours, colours);
  EXPECT_EQ(written.primitives[0].positions, a.primitives[0].positions);
}

}  // namespace
}  // namespace morphbake
