#include "morphbake/recipe/read_landmarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recipe_folder.h"

namespace morphbake {
namespace {

TEST(ReadLandmarks, ReadsTheThreeWays) {
  const test::RecipeFolder folder;
  const auto file = folder.write("x.landmarks.json", R"({"version": 1, "landmarks": {
      "p": {"position": [0, 1, 2]}, "v": {"vertex": 7},
      "f": {"face": 3, "barycentric": [0.2, 0.3, 0.5]}}})");
  const std::vector<Landmark> landmarks = read_landmarks(file, "x");
  ASSERT_EQ(landmarks.size(), 3U);
  EXPECT_EQ(std::get<Eigen::Vector3d>(landmarks[0].at), Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(std::get<VertexPlace>(landmarks[1].at).vertex, 7);
  EXPECT_EQ(std::get<TrianglePlace>(landmarks[2].at).triangle, 3);
  EXPECT_EQ(std::get<TrianglePlace>(landmarks[2].at).barycentric, Eigen::Vector3d(0.2, 0.3, 0.5));
}

TEST(LandmarksToJson, ReadsBackExactly) {
  const test::RecipeFolder folder;
  const Eigen::Vector3d odd(0.1 + 0.2, -1.0 / 3, 5e-324);
  const Eigen::Vector3d shares(1.0 / 3, 1.0 / 3, 1 - 2 * (1.0 / 3));
  const auto file = folder.path / "x.landmarks.json";
  const std::string text =
      landmarks_to_json({{"p", odd}, {"v", VertexPlace{7}}, {"f\"/", TrianglePlace{3, shares}}},
                        file, folder.path / "schemas/landmarks.schema.json");
  EXPECT_THAT(text, testing::HasSubstr("\"$schema\": \"schemas/landmarks.schema.json\""));
  folder.write("x.landmarks.json", text);
  const std::vector<Landmark> landmarks = read_landmarks(file, "x");
  ASSERT_EQ(landmarks.size(), 3U);
  EXPECT_EQ(std::get<Eigen::Vector3d>(landmarks[0].at), odd);
  EXPECT_EQ(landmarks[2].name, "f\"/");
  EXPECT_EQ(std::get<TrianglePlace>(landmarks[2].at).barycentric, shares);
  EXPECT_EQ(landmarks_to_json(landmarks, file, ""), landmarks_to_json(landmarks, file, ""));
}

}  // namespace
}  // namespace morphbake
