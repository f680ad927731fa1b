#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "recipe_folder.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<fs::path> expectations() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(MORPHBAKE_SOURCE_DIR "/tests/cli/bad_recipes")) {
    if (entry.path().extension() == ".expected") files.push_back(entry.path());
  }
  return files;
}

TEST(BadRecipes, AreToldWhatIsWrong) {
  const test::RecipeFolder folder;
  fs::copy(MORPHBAKE_SOURCE_DIR "/tests/cli/bad_recipes", folder.path);
  const std::vector<fs::path> files = expectations();
  EXPECT_GE(files.size(), 60U);
  for (const fs::path& file : files) {
    const std::string said = folder.problems(folder.path / file.stem().concat(".json"));
    const std::vector<std::string> expected = lines_of(file);
    ASSERT_GE(expected.size(), 2U) << file;
    EXPECT_EQ(expected[0], "2") << file;
    for (std::size_t i = 1; i < expected.size(); ++i) {
      EXPECT_NE(said.find(expected[i]), std::string::npos)
          << file << " lacks: " << expected[i] << "\nsaid: " << said;
    }
  }
}

}  // namespace
}  // namespace morphbake
