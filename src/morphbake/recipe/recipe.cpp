#include "morphbake/recipe/recipe.h"

#include <utility>

namespace morphbake {
namespace {

bool lies_in(std::string_view pointer, std::string_view part) {
  return pointer.starts_with(part) &&
         (pointer.size() == part.size() || pointer[part.size()] == '/');
}

}  // namespace

const std::filesystem::path& written_in(const std::vector<RecipePart>& parts,
                                        std::string_view pointer) {
  const RecipePart* best = &parts.front();
  for (const RecipePart& part : parts) {
    if (part.pointer.size() >= best->pointer.size() && lies_in(pointer, part.pointer)) best = &part;
  }
  return best->file;
}

Location location_in(const Recipe& recipe, std::string pointer) {
  const std::filesystem::path& file =
      recipe.parts.empty() ? recipe.file : written_in(recipe.parts, pointer);
  return {file.string(), std::move(pointer), 0, 0};
}

}  // namespace morphbake
