#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::test {

/// A folder of its own with sources that are empty: read_recipe looks at their names only.
class RecipeFolder {
 public:
  RecipeFolder() {
    path = std::filesystem::temp_directory_path() /
           ("morphbake-recipe-" + std::to_string(std::random_device{}()));
    std::filesystem::create_directories(path);
    write("a.glb", "");
    write("b.glb", "");
    write("a.landmarks.json", R"({"version": 1, "landmarks": {"nose": {"position": [0, 0, 1]}}})");
  }

  RecipeFolder(const RecipeFolder&) = delete;
  RecipeFolder& operator=(const RecipeFolder&) = delete;

  ~RecipeFolder() { std::filesystem::remove_all(path); }

  std::filesystem::path write(const std::filesystem::path& name, const std::string& text) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << text;
    return path / name;
  }

  Recipe read(const std::string& text) const { return read_recipe(write("recipe.json", text)); }

  /// All problems of a recipe as they are printed, or "".
  std::string problems(const std::filesystem::path& file) const {
    try {
      read_recipe(file);
    } catch (const BakeError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path path;
};

}  // namespace morphbake::test
