#include "morphbake/bake/stage_keys.h"

#include <fmt/core.h>

#include <array>
#include <set>
#include <utility>

#include "morphbake/json/json.h"
#include "morphbake/recipe/read_landmarks.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// A recipe as JSON, and what is known of the files that it names.
struct Described {
  const Recipe& recipe;
  Json document;
  Json options;  ///< of all stages, as options_to_json
  InputFiles& files;
};

StageKey key_of(std::string name, const Json& description) {
  std::string text = description.dump();
  std::string key = content_hash(text);
  return {std::move(name), std::move(text), std::move(key)};
}

const std::vector<fs::path>& beside(const fs::path& file, InputFiles& files) {
  const auto found = files.beside.find(file);
  if (found != files.beside.end()) return found->second;
  return files.beside.emplace(file, files_beside(file)).first->second;
}

Json or_null(const Json& document, const char* field) { return document.value(field, Json()); }

/// The entries of an object that the document may have: finding each by itself would take long in
/// recipes of thousands.
std::map<std::string, Json> entries_of(const Json& document, const char* field) {
  std::map<std::string, Json> entries;
  const auto object = document.find(field);
  if (object == document.end()) return entries;
  for (const auto& [name, value] : object->items()) entries.emplace(name, value);
  return entries;
}

/// Hashes of a mesh and of all that it names; null for what is not there.
Json content_of(const fs::path& mesh, InputFiles& files) {
  Json contents = {files.hashes.of(mesh)};
  for (const fs::path& file : beside(mesh, files)) {
    std::error_code error;
    const bool is_there = fs::is_regular_file(file, error);
    contents.push_back(is_there ? Json(files.hashes.of(file)) : Json());
  }
  return contents;
}

/// The recipe's sources with a file: what they say, with contents in the stead of names of files.
Json described_sources(const Described& described) {
  std::map<std::string, Json> written = entries_of(described.document, "sources");
  Json sources = Json::object();
  for (const SourceRef& source : described.recipe.sources) {
    Json json = std::move(written[source.name]);
    if (!json.is_object()) json = Json::object();
    json["file"] = content_of(source.file, described.files);
    json["landmarks"] =
        parse_json(landmarks_to_json(source.landmarks, source.file, {}), source.name);
    sources[source.name] = std::move(json);
  }
  return sources;
}

/// The recipe's sources that are made from others.
Json derived_sources(const Described& described) {
  std::map<std::string, Json> written = entries_of(described.document, "sources");
  Json sources = Json::object();
  for (const DerivedSource& source : described.recipe.derived) {
    sources[source.name] = std::move(written[source.name]);
  }
  return sources;
}

StageKey describe_connectivity(const Described& described) {
  return key_of("connectivity", {{"stage", "connectivity"},
                                 {"program", program_hash()},
                                 {"sources", described_sources(described)},
                                 {"connectivity", or_null(described.document, "connectivity")},
                                 {"units", or_null(described.document, "units")}});
}

StageKey describe_regions(const Described& described, const StageKey& connectivity) {
  return key_of("regions", {{"stage", "regions"},
                            {"connectivity", connectivity.key},
                            {"units", or_null(described.document, "units")},
                            {"regions", or_null(described.document, "regions")}});
}

StageKey describe_derived(const Described& described, const StageKey& connectivity) {
  return key_of("derived sources", {{"stage", "derived"},
                                    {"connectivity", connectivity.key},
                                    {"units", or_null(described.document, "units")},
                                    {"sources", derived_sources(described)},
                                    {"regions", or_null(described.document, "regions")}});
}

/// The pictures that mark regions.
std::vector<fs::path> mask_files(const Recipe& recipe) {
  std::vector<fs::path> files;
  for (const RegionOfInterest& region : recipe.regions) {
    const auto* mask = std::get_if<MaskRegion>(&region.shape);
    const auto* image = mask == nullptr ? nullptr : std::get_if<ImageMask>(&mask->by);
    if (image != nullptr) files.push_back(image->file);
  }
  return files;
}

Json mask_hashes(const Described& described) {
  Json hashes = Json::array();
  for (const fs::path& file : mask_files(described.recipe)) {
    hashes.push_back(described.files.hashes.of(file));
  }
  return hashes;
}

StageKey describe_shapes(const Described& described, const StageKey& connectivity) {
  Json description = {{"stage", "shapes"},
                      {"connectivity", connectivity.key},
                      {"masks", mask_hashes(described)},
                      {"options", described.options["solve"]}};
  for (const char* field : {"units", "regions", "representation", "hold", "gauge"}) {
    description[field] = or_null(described.document, field);
  }
  return key_of("shapes", description);
}

StageKey describe_solve(const Described& described, const StageKey& connectivity) {
  // Fields of which other stages' descriptions have what they need, or that decide nothing.
  constexpr std::array kElsewhere = {"$schema", "include", "sources", "connectivity", "options",
                                     "outputs", "preview", "name",    "version"};
  Json rest = described.document;
  for (const char* field : kElsewhere) rest.erase(field);
  return key_of("solve",
                {{"stage", "solve"},
                 {"connectivity", connectivity.key},
                 {"derived", derived_sources(described)},
                 {"recipe", std::move(rest)},
                 {"masks", mask_hashes(described)},
                 {"options",
                  {{"solve", described.options["solve"]}, {"basis", described.options["basis"]}}}});
}

/// The file of an output's own profile; empty when it has none, or a shipped one.
fs::path profile_file(const Recipe& recipe, const Json& output) {
  const std::string name = output.value("profile", "");
  if (!name.ends_with(".json")) return {};
  return fs::absolute(recipe.file).parent_path() / name;
}

StageKey describe_output(const Described& described, std::size_t index, const StageKey& solve) {
  const Json outputs = or_null(described.document, "outputs");  // without, there is one
  Json output = outputs.is_array() ? outputs[index] : Json::object();
  const fs::path profile = profile_file(described.recipe, output);
  if (!profile.empty()) output["profile"] = described.files.hashes.of(profile);
  output.erase("file");
  const std::string file = described.recipe.outputs[index].file.filename().string();
  return key_of("output " + file, {{"stage", "output"},
                                   {"solve", solve.key},
                                   {"name", described.recipe.name},
                                   {"output", std::move(output)}});
}

/// @param shown  the output that they show
StageKey describe_preview(const Described& described, const StageKey& shown) {
  Json preview = or_null(described.document, "preview");
  preview.erase("maps");
  return key_of("preview of " + shown.name.substr(std::string_view("output ").size()),
                {{"stage", "preview"},
                 {"of", shown.key},
                 {"preview", std::move(preview)},
                 {"turntable", described.options["turntable"]}});
}

StageKey describe_maps(const Described& described, const StageKey& solve) {
  return key_of("maps", {{"stage", "maps"},
                         {"of", solve.key},
                         {"maps", described.document.at("preview").at("maps")},
                         {"turntable", described.options["turntable"]}});
}

}  // namespace

BakeKeys no_keys(const Recipe& recipe) {
  BakeKeys keys;
  keys.outputs.resize(recipe.outputs.size());
  keys.previews.resize(recipe.outputs.size());
  return keys;
}

BakeKeys bake_keys(const Recipe& recipe, const BakeOptions& options, InputFiles& files) {
  const Described described{recipe, parse_json(recipe.document, recipe.file.string()),
                            parse_json(options_to_json(options), "options"), files};
  BakeKeys keys;
  keys.connectivity = describe_connectivity(described);
  keys.regions = describe_regions(described, keys.connectivity);
  keys.derived = describe_derived(described, keys.connectivity);
  keys.shapes = describe_shapes(described, keys.connectivity);
  keys.solve = describe_solve(described, keys.connectivity);
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    keys.outputs.push_back(describe_output(described, i, keys.solve));
  }
  if (!recipe.preview) return keys;
  for (const StageKey& output : keys.outputs) {
    keys.previews.push_back(describe_preview(described, output));
  }
  if (!recipe.preview->maps.empty()) keys.maps = describe_maps(described, keys.solve);
  return keys;
}

std::string connectivity_key(const Recipe& recipe, InputFiles& files) {
  return describe_connectivity(
             {recipe, parse_json(recipe.document, recipe.file.string()), {}, files})
      .key;
}

std::string bake_key(const BakeKeys& keys) {
  std::string all;
  for (const std::vector<StageKey>& stages : {keys.outputs, keys.previews}) {
    for (const StageKey& stage : stages) all += stage.key;
  }
  return content_hash(all + keys.maps.key);
}

std::vector<fs::path> files_read_by(const Recipe& recipe, InputFiles& files) {
  std::vector<fs::path> read;
  for (const RecipePart& part : recipe.parts) {
    if (part.line == 0) read.push_back(part.file);  // the others are changes from a list
  }
  for (const SourceRef& source : recipe.sources) {
    read.push_back(source.file);
    read.insert(read.end(), beside(source.file, files).begin(), beside(source.file, files).end());
    read.push_back(landmarks_beside(source.file));
    read.emplace_back(source.landmarks_at.file);
  }
  const std::vector<fs::path> masks = mask_files(recipe);
  read.insert(read.end(), masks.begin(), masks.end());
  const Json document = parse_json(recipe.document, recipe.file.string());
  for (const Json& output : document.value("outputs", Json::array())) {
    const fs::path profile = profile_file(recipe, output);
    if (!profile.empty()) read.push_back(profile);
  }
  std::set<fs::path> distinct;
  for (const fs::path& file : read) distinct.insert(fs::absolute(file).lexically_normal());
  return {distinct.begin(), distinct.end()};
}

}  // namespace morphbake
