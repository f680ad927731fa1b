#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/recipe/read_recipe.h"
#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t stem_bytes = 24;  // leaves room for "-to-" and a number

/// A file's stem as a name: no ":" or control characters, short, never empty.
std::string name_from(const fs::path& file) {
  std::string name = file.stem().string();
  std::replace_if(
      name.begin(), name.end(),
      [](char letter) {
        return letter == ':' || letter == '\\' || letter == '\x7f' ||
               (letter >= '\0' && letter < ' ');
      },
      '-');
  if (name.size() > stem_bytes) {
    std::size_t end = stem_bytes;
    // A UTF-8 letter must not be cut.
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
    name.resize(end);
  }
  return name.empty() ? "source" : name;
}

std::vector<std::string> unique_names(const std::vector<fs::path>& sources) {
  std::vector<std::string> names;
  for (const fs::path& source : sources) {
    const std::string name = name_from(source);
    std::string unique = name;
    for (int i = 2; std::find(names.begin(), names.end(), unique) != names.end(); ++i) {
      unique = fmt::format("{}-{}", name, i);
    }
    names.push_back(std::move(unique));
  }
  return names;
}

/// The first landmark of the first source that all sources have, or "".
std::string common_landmark(const std::vector<fs::path>& sources) {
  std::vector<std::vector<Landmark>> landmarks;
  for (const fs::path& source : sources) {
    const fs::path beside = landmarks_beside(source);
    std::error_code error;
    if (!fs::exists(beside, error)) return "";
    landmarks.push_back(read_landmarks(beside, beside.string()));
  }
  for (const Landmark& each : landmarks.front()) {
    const bool common = std::all_of(landmarks.begin(), landmarks.end(), [&](const auto& others) {
      return index_of(others, each.name) >= 0;
    });
    if (common) return each.name;
  }
  return "";
}

/// The name of the region outside `landmark`'s.
std::string rest_name(const std::string& landmark) {
  return landmark == "rest" ? "others" : "rest";
}

Json regions_around(const std::string& landmark, const std::string& source) {
  Json regions;
  regions[landmark]["ball"] = {{"on", source}, {"at", landmark}, {"inner", 0.05}, {"outer", 0.12}};
  regions[rest_name(landmark)]["rest_of"] = Json::array({landmark});
  return regions;
}

/// The region around the landmark moves first, then the rest; further sources follow as a whole.
Json tracks_through(const std::vector<std::string>& names, const std::string& landmark) {
  Json tracks = Json::array();
  std::string last = names[1];
  if (landmark.empty()) {
    tracks.push_back({{"name", names[1]}, {"to", names[1]}, {"begin", 0.5}, {"duration", 2}});
  } else {
    last = rest_name(landmark);
    tracks.push_back({{"region", landmark}, {"to", names[1]}, {"begin", 0.5}, {"end", 1.5}});
    tracks.push_back(
        {{"region", last}, {"to", names[1]}, {"begin", {{"after", landmark}}}, {"duration", 1.5}});
  }
  for (std::size_t i = 2; i < names.size(); ++i) {
    const std::string name = "to " + names[i];
    tracks.push_back({{"name", name},
                      {"to", names[i]},
                      {"begin", {{"after", last}, {"delay", 0.5}}},
                      {"duration", 2}});
    last = name;
  }
  return tracks;
}

void check_sources(const std::vector<fs::path>& sources) {
  std::vector<Problem> problems;
  if (sources.size() < 2) {
    problems.push_back({Severity::Error,
                        "recipe.too-few-sources",
                        {},
                        "a morph needs two sources or more",
                        "name two or more glTF files"});
  }
  for (const fs::path& source : sources) {
    std::error_code error;
    if (fs::is_regular_file(source, error)) continue;
    problems.push_back({Severity::Error,
                        "recipe.missing-file",
                        {source.string(), ""},
                        "there is no such file",
                        ""});
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
}

}  // namespace

std::string relative_name(const fs::path& file, const fs::path& from) {
  const fs::path folder = fs::absolute(from).parent_path().lexically_normal();
  const fs::path named = fs::absolute(file).lexically_normal();
  const fs::path relative = named.lexically_relative(folder);
  return (relative.empty() ? named : relative).generic_string();
}

std::string first_recipe(const std::vector<fs::path>& sources, const fs::path& recipe_file,
                         const fs::path& schema, const FirstChoices& choices) {
  check_sources(sources);
  const std::vector<std::string> names = unique_names(sources);
  const std::string landmark = common_landmark(sources);
  Json recipe;
  if (!schema.empty()) recipe["$schema"] = relative_name(schema, recipe_file);
  recipe["version"] = 1;
  recipe["name"] = names.front() + "-to-" + names.back();
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::string file = relative_name(sources[i], recipe_file);
    Json& source = recipe["sources"][names[i]];
    source = file;
    const bool is_unlike = i < choices.is_unlike.size() && choices.is_unlike[i];
    const NameOrIndex node = i < choices.nodes.size() ? choices.nodes[i] : NameOrIndex();
    if (is_unlike || is_chosen(node)) source = {{"file", file}};
    if (const auto* name = std::get_if<std::string>(&node)) source["node"] = *name;
    if (const auto* index = std::get_if<int>(&node)) source["node"] = *index;
    if (is_unlike) source["align"] = "similarity";
  }
  if (choices.remesh) recipe["connectivity"] = {{"mode", "remesh"}};
  if (!landmark.empty()) recipe["regions"] = regions_around(landmark, names[0]);
  recipe["timeline"] = {{"fps", 30}, {"start", names[0]}};
  recipe["timeline"]["tracks"] = tracks_through(names, landmark);
  recipe["outputs"] =
      Json::array({{{"file", fmt::format("out/{}.glb", recipe["name"].get<std::string>())}}});
  recipe["preview"] = {{"turntable", {{"size", {512, 512}}, {"frames", 72}}},
                       {"formats", {"gif", "sheet"}}};
  return recipe.dump(2) + "\n";
}

}  // namespace morphbake
