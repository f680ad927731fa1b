#include "morphbake/recipe/includes.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFiles = 100;
constexpr std::array kByName = {"sources", "regions", "states"};
constexpr std::array kOwn = {"$schema", "version", "name", "include"};

template <typename List>
bool holds(const List& list, std::string_view field) {
  return std::ranges::find(list, field) != list.end();
}

/// What one file says, with what it includes.
class Reader {
 public:
  /// @param file  as the caller calls it
  WholeRecipe read(const fs::path& file, const Location& at) {
    check_file(file, at);
    open_.push_back(file);
    const Json own = read_json(file, file.string());
    WholeRecipe whole{Json::object(), {{"", file}}};
    const auto includes = own.is_object() ? own.find("include") : own.end();
    if (includes != own.end() && includes->is_array()) {
      for (std::size_t i = 0; i < includes->size(); ++i) {
        if (!(*includes)[i].is_string()) continue;  // the schema tells
        const fs::path name = (*includes)[i].get<std::string>();
        const fs::path named = (file.parent_path() / name).lexically_normal();
        const Location here{file.string(), child_pointer("/include", i), 0, 0};
        if (!is_in(closed_, named)) join(whole, read(named, here), here);
      }
    }
    open_.pop_back();
    closed_.push_back(file);
    if (!own.is_object()) return {own, {{"", file}}};
    put_own(whole, own, file);
    return whole;
  }

 private:
  static bool is_in(const std::vector<fs::path>& files, const fs::path& file) {
    return std::ranges::any_of(files, [&file](const fs::path& other) {
      std::error_code error;
      return file == other || (fs::equivalent(file, other, error) && !error);
    });
  }

  void check_file(const fs::path& file, const Location& at) {
    if (is_in(open_, file)) {
      throw BakeError(Problem{Severity::Error, "recipe.cycle", at,
                              fmt::format("{} includes itself", shown(Json(file.string()))),
                              "take out one of the includes"});
    }
    if (++files_ > kMostFiles) {
      throw BakeError(Problem{Severity::Error, "recipe.too-many-includes", at,
                              fmt::format("more than {} files are included", kMostFiles),
                              "put them together"});
    }
    const fs::path extension = file.extension();
    if (!open_.empty() && (extension == ".glb" || extension == ".gltf")) {
      throw BakeError(Problem{Severity::Error, "recipe.wrong-type", at,
                              fmt::format("{} is a mesh, no recipe", shown(Json(file.string()))),
                              "meshes stand in \"sources\""});
    }
    std::error_code error;
    if (open_.empty() || fs::is_regular_file(file, error)) return;  // of the first one others tell
    const std::string name = shown(Json(file.string()));
    const std::string message =
        fs::exists(file, error) ? name + " is no regular file" : "there is no file " + name;
    throw BakeError(Problem{Severity::Error, "recipe.missing-file", at, message,
                            "names start at the folder of the file that includes"});
  }

  static void refuse_twice(const WholeRecipe& whole, const std::string& pointer,
                           const Location& at) {
    throw BakeError(Problem{Severity::Error, "recipe.duplicate-name", at,
                            fmt::format("{} is in {} already", pointer,
                                        shown(Json(written_in(whole.parts, pointer).string()))),
                            "only what a file says itself may stand in place of what it includes"});
  }

  /// Adds what one more included file says.
  static void join(WholeRecipe& whole, WholeRecipe added, const Location& at) {
    if (!added.document.is_object()) {
      throw BakeError(Problem{Severity::Error, "recipe.wrong-type", at,
                              "the included file is no JSON object", "it is written as a recipe"});
    }
    if (added.document.value("version", Json()) != 1) {
      throw BakeError(Problem{Severity::Error,
                              "recipe.bad-value",
                              {added.parts.front().file.string(), "/version", 0, 0},
                              "an included file has a version as well",
                              "write \"version\": 1"});
    }
    for (auto& [field, value] : added.document.items()) {
      if (holds(kOwn, field)) continue;
      const auto there = whole.document.find(field);
      if (there == whole.document.end()) {
        whole.document[field] = std::move(value);
        continue;
      }
      const bool are_named = holds(kByName, field) && there->is_object() && value.is_object();
      if (!are_named) refuse_twice(whole, "/" + field, at);
      for (auto& [name, entry] : value.items()) {
        if (there->contains(name)) refuse_twice(whole, child_pointer("/" + field, name), at);
        (*there)[name] = std::move(entry);
      }
    }
    for (RecipePart& part : added.parts) {
      if (!part.pointer.empty()) whole.parts.push_back(std::move(part));
    }
  }

  /// Puts what a file says itself in place of what it includes.
  static void put_own(WholeRecipe& whole, const Json& own, const fs::path& file) {
    for (const auto& [field, value] : own.items()) {
      const std::string pointer = "/" + field;
      const auto there = whole.document.find(field);
      const bool are_named = holds(kByName, field) && value.is_object() &&
                             (there == whole.document.end() || there->is_object());
      if (!are_named) {
        whole.document[field] = value;
        whole.parts.push_back({pointer, file});
        continue;
      }
      Json& list = there == whole.document.end() ? whole.document[field] = Json::object() : *there;
      for (const auto& [name, entry] : value.items()) {
        list[name] = entry;
        whole.parts.push_back({child_pointer(pointer, name), file});
      }
    }
  }

  std::vector<fs::path> open_;    ///< from the first file on
  std::vector<fs::path> closed_;  ///< read: what several files include counts once
  int files_ = 0;
};

}  // namespace

WholeRecipe read_with_includes(const fs::path& file) { return Reader().read(file, {}); }

}  // namespace morphbake
