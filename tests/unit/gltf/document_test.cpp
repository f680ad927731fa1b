#include "morphbake/gltf/document.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/gltf/nodes.h"
#include "morphbake/gltf/resources.h"
#include "morphbake/gltf/size_limits.h"

namespace morphbake {
namespace fs = std::filesystem;

namespace {

const std::string kPng = "\x89PNG\r\n\x1a\n";

/// A folder for files beside a glTF.
class Document : public testing::Test {
 protected:
  Document() {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }

  ~Document() override { fs::remove_all(folder); }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }

  GltfFile open(Json json) const {
    json["asset"]["version"] = "2.0";
    return open_gltf_bytes(json.dump(), folder / "a.gltf");
  }

  /// "code pointer" of what is wrong with it.
  std::string fault(const Json& json) const {
    try {
      open(json);
    } catch (const BakeError& error) {
      const Problem& problem = error.problems().front();
      return problem.code + " " + problem.location.pointer;
    }
    return "";
  }

  fs::path folder =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

Json buffer_of(const std::string& uri, std::size_t size) {
  return {{"buffers", {{{"uri", uri}, {"byteLength", size}}}}};
}

Json image_of(const std::string& uri) { return {{"images", {{{"uri", uri}}}}}; }

TEST_F(Document, BytesThatAreNotThereAreToldWithTheirPlace) {
  write("short.bin", "123");
  write("empty.png", "");
  EXPECT_EQ(fault(buffer_of("short.bin", 4)), "gltf.invalid /buffers/0");
  EXPECT_EQ(fault(buffer_of("data:;base64,AAAA", 4)), "gltf.invalid /buffers/0");
  EXPECT_EQ(fault(buffer_of("data:;base64,A", 1)), "gltf.invalid /buffers/0/uri");
  EXPECT_EQ(fault({{"buffers", {{{"byteLength", 4}}}}}), "gltf.invalid /buffers/0");
  EXPECT_EQ(fault(image_of("empty.png")), "gltf.invalid /images/0");
  EXPECT_EQ(fault(image_of("data:image/webp;base64,")), "gltf.invalid /images/0");
  EXPECT_EQ(fault(image_of("data:image/webp;base64,?")), "gltf.invalid /images/0/uri");
  EXPECT_EQ(fault(image_of("gone.png")), "gltf.missing-file /images/0/uri");
}

// glTF 2.0, 3.6.1: a file may have more bytes than its buffer.
TEST_F(Document, OfALongerFileTheBufferIsTheStart) {
  write("a+b.bin", "123456");
  for (const char* uri : {"a+b.bin", "a%2Bb.bin", "data:;base64,MTIzNDU2", "data:,12345"}) {
    const GltfFile file = open(buffer_of(uri, 4));
    EXPECT_EQ(file->buffers.at(0), "1234") << uri;
  }
}

TEST_F(Document, ImagesOfEveryKindKeepTheirBytes) {
  write("a+b.png", kPng);
  write("texture.dds", "DDS |");
  const std::tuple<const char*, std::string, const char*> cases[] = {
      {"a+b.png", kPng, "image/png"},
      {"texture.dds", "DDS |", "image/vnd-ms.dds"},
      {"data:image/webp;base64,MTIzNA==", "1234", "image/webp"},
      {"data:image/avif,1%202", "1 2", "image/avif"}};
  for (const auto& [uri, bytes, type] : cases) {
    const GltfFile file = open(image_of(uri));
    EXPECT_EQ(image_bytes(*file, 0), bytes) << uri;
    EXPECT_EQ(file->model.images[0].mimeType, type) << uri;
  }
}

TEST_F(Document, AnImageInABufferViewIsNotCopied) {
  Json json = buffer_of("data:;base64,MTIzNDU2", 6);
  json["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 2}, {"byteLength", 3}}};
  json["images"] = {{{"bufferView", 0}, {"mimeType", "image/x"}}};
  const GltfFile file = open(json);
  EXPECT_EQ(image_bytes(*file, 0), "345");
  EXPECT_TRUE(file->model.images[0].image.empty());
  EXPECT_EQ(file->model.images[0].mimeType, "image/x");
}

TEST_F(Document, FieldsKeepTheirOrder) {
  Json json = {{"extras", {1}},
               {"images", Json::array()},
               {"cameras", {{{"x", 1}}}},
               {"buffers", Json::array()},
               {"extensions", {{"E", 2}}}};
  json["asset"]["version"] = "2.0";
  EXPECT_EQ(open(json)->json.dump(), json.dump());
}

/// A mesh of `attributes`, whose accessors have `count` elements that are all 0.
Json zeros(std::size_t count, const Json& attributes, const Json& targets) {
  Json json;
  json["accessors"] = {{{"componentType", 5126}, {"count", count}, {"type", "VEC3"}}};
  json["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"targets", targets}}}}}};
  return json;
}

// The numbers of these files are sparse: hardly any of their rows takes bytes.
TEST_F(Document, SixtyTargetsOfAHundredThousandVerticesAreNotTooMany) {
  const Json targets(60, {{"POSITION", 0}, {"NORMAL", 0}});
  const GltfFile file = open(zeros(100000, {{"POSITION", 0}, {"NORMAL", 0}}, targets));
  EXPECT_NO_THROW(check_mesh_size(*file, 0));
}

TEST_F(Document, EveryRowThatIsReadIsCounted) {
  const Json normals(17, {{"NORMAL", 0}});
  EXPECT_THROW(check_mesh_size(*open(zeros(1000000, {{"POSITION", 0}}, normals)), 0), BakeError);
  const Json joints = {
      {"POSITION", 0}, {"JOINTS_0", 0}, {"WEIGHTS_0", 0}, {"JOINTS_1", 0}, {"JOINTS_2", 0}};
  EXPECT_THROW(check_mesh_size(*open(zeros(1000000, joints, Json::array())), 0), BakeError);
}

// A joint of scale 0 hides what hangs on it; the mesh is where the other ones bind it.
TEST_F(Document, FlatJointsDoNotTellWhereAMeshIs) {
  Json json;
  json["meshes"] = {{{"primitives", Json::array()}}};
  json["nodes"] = {{{"mesh", 0}, {"skin", 0}},
                   {{"scale", {0, 0, 0}}},
                   {{"translation", {5, 0, 0}}},
                   {{"translation", {6, 0, 0}}}};
  json["skins"] = {{{"joints", {1, 2, 3}}}};
  EXPECT_EQ(choose_mesh_node(*open(json), {}, Ambiguity::Refuse).to_scene(0, 3), 5);
  json["skins"] = {{{"joints", {1}}}};
  EXPECT_TRUE(choose_mesh_node(*open(json), {}, Ambiguity::Refuse).to_scene.isIdentity());
}

}  // namespace
}  // namespace morphbake
