#include "morphbake/gltf/target_rows.h"

#include <gtest/gtest.h>

#include <limits>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/gltf/document.h"
#include "morphbake/gltf/glb_draft.h"

namespace morphbake {
namespace {

constexpr int kVertices = 3000;  // several parts

/// Rows of a file that are dense floats, sparse, and normalised shorts with a stride.
class TargetRowsOfAFile : public testing::Test {
 protected:
  TargetRowsOfAFile() {
    draft_.shown = "source.glb";
    draft_.json = Json::parse(R"({
      "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_mesh_quantization"],
      "extensionsRequired": ["KHR_mesh_quantization"],
      "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{}]}]})");
    std::srand(1);  // of Eigen's Random
    Json& primitive = draft_.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = append_vectors(draft_, Float3s::Random(kVertices, 3));
    primitive["attributes"]["NORMAL"] = append_vectors(draft_, Float3s::Random(kVertices, 3));
    dense_ = Float3s::Random(kVertices, 3);
  }

  int append_sparse() {
    const std::vector<std::uint16_t> rows = {0, 5, 1023, 1024, 2999};
    const Float3s values = Float3s::Random(5, 3);
    const int of_rows = append_view(draft_, rows.data(), 2 * rows.size(), BufferUse::Other);
    const int of_values = append_view(draft_, values.data(), 60, BufferUse::Other);
    return append_accessor(draft_,
                           {{"componentType", kFloatComponent},
                            {"count", kVertices},
                            {"type", "VEC3"},
                            {"sparse",
                             {{"count", 5},
                              {"indices", {{"bufferView", of_rows}, {"componentType", 5123}}},
                              {"values", {{"bufferView", of_values}}}}}});
  }

  int append_shorts() {
    std::vector<std::int16_t> numbers;
    for (int i = 0; i < 4 * kVertices; ++i) numbers.push_back(static_cast<std::int16_t>(37 * i));
    Json view = append_bytes(draft_, numbers.data(), 2 * numbers.size(), BufferUse::Vertices);
    view["byteStride"] = 8;
    return append_accessor(draft_, {{"bufferView", add_view(draft_, view)},
                                    {"componentType", 5122},
                                    {"normalized", true},
                                    {"count", kVertices},
                                    {"type", "VEC3"}});
  }

  GltfFile open() {
    Json& primitive = draft_.json["meshes"][0]["primitives"][0];
    primitive["targets"] = Json::array();
    primitive["targets"].push_back({{"POSITION", append_vectors(draft_, dense_)}});
    primitive["targets"].push_back({{"POSITION", append_sparse()}, {"NORMAL", append_shorts()}});
    return open_gltf_bytes(glb_bytes(draft_), "source.glb");
  }

  GlbDraft draft_;
  Float3s dense_;
};

TEST_F(TargetRowsOfAFile, RefuseNumbersThatAreNotFinite) {
  dense_(2047, 1) = std::numeric_limits<float>::quiet_NaN();
  try {
    TargetRows(open(), 0);
    FAIL();
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems()[0].code, "gltf.not-finite");
    EXPECT_EQ(error.problems()[0].location.pointer, "/meshes/0/primitives/0/targets/0/POSITION");
    EXPECT_NE(error.problems()[0].message.find("element 2047 "), std::string::npos);
  }
}

TEST_F(TargetRowsOfAFile, ArePartsOfWhatIsReadAtOnce) {
  const GltfFile file = open();
  const TargetRows targets(file, 0);
  const AnimatedMesh whole = read_animated_mesh(file);
  const AnimatedPrimitive& primitive = whole.primitives[0];
  const TargetRows in_memory(whole);
  EXPECT_TRUE(read_base_mesh(file).primitives[0].target_positions.empty());
  ASSERT_EQ(targets.count(), 2U);
  for (std::size_t t = 0; t < 2; ++t) {
    for (const MorphedAttribute attribute :
         {MorphedAttribute::Position, MorphedAttribute::Normal}) {
      const TargetPlace place{0, t, attribute};
      const Float3s& expected = attribute == MorphedAttribute::Position
                                    ? primitive.target_positions[t]
                                    : primitive.target_normals[t];
      ASSERT_EQ(targets.has(place), expected.rows() > 0);
      ASSERT_EQ(in_memory.has(place), expected.rows() > 0);
      if (!targets.has(place)) continue;
      for (const auto& [begin, count] :
           {std::pair(0, 3000), {0, 5}, {5, 1}, {6, 1018}, {1023, 2}, {1025, 1974}, {2999, 1}}) {
        Float3s part(count, 3), other(count, 3);
        targets.read(place, begin, count, part.data());
        in_memory.read(place, begin, count, other.data());
        EXPECT_EQ(part, expected.middleRows(begin, count)) << t << " " << begin;
        EXPECT_EQ(other, part);
      }
    }
    const Eigen::AlignedBox3f& bounds = targets.bounds(0, t);
    EXPECT_EQ(bounds.min().transpose(), primitive.target_positions[t].colwise().minCoeff());
    EXPECT_EQ(bounds.max().transpose(), primitive.target_positions[t].colwise().maxCoeff());
  }
}

}  // namespace
}  // namespace morphbake
