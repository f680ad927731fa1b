#include "morphbake/bake/bake_cache.h"

#include <array>
#include <utility>

#include "morphbake/json/json.h"

namespace morphbake {
namespace {

/// A kind of file that a recipe names, each with what messages call them.
struct NamedFiles {
  const char* kind;
  std::vector<std::string> names;
};

/// Recipes that share an entry call the same files differently: warnings are kept by number.
std::array<NamedFiles, 3> named_files(const Recipe& recipe) {
  std::array<NamedFiles, 3> named = {{{"part", {}}, {"source", {}}, {"output", {}}}};
  for (const RecipePart& part : recipe.parts) named[0].names.push_back(part.file.string());
  for (const SourceRef& source : recipe.sources) named[1].names.push_back(source.file.string());
  for (const Output& output : recipe.outputs) named[2].names.push_back(output.file.string());
  return named;
}

Json described_file(const std::string& file, const Recipe& recipe) {
  for (const NamedFiles& files : named_files(recipe)) {
    const auto found = std::ranges::find(files.names, file);
    if (found != files.names.end()) return {{files.kind, found - files.names.begin()}};
  }
  return file;
}

std::string file_described(const Json& json, const Recipe& recipe) {
  if (json.is_string()) return json.get<std::string>();
  for (const NamedFiles& files : named_files(recipe)) {
    if (!json.contains(files.kind)) continue;
    const auto index = json[files.kind].get<std::size_t>();
    // A part that the other recipe has and this one has not: both are this one's own words.
    return files.names.at(index < files.names.size() ? index : 0);
  }
  return recipe.file.string();
}

Json to_json(const std::vector<Problem>& warnings, const Recipe& recipe) {
  Json list = Json::array();
  for (const Problem& warning : warnings) {
    list.push_back({{"code", warning.code},
                    {"file", described_file(warning.location.file, recipe)},
                    {"pointer", warning.location.pointer},
                    {"message", warning.message},
                    {"hint", warning.hint}});
  }
  return list;
}

std::vector<Problem> warnings_of(const Json& list, const Recipe& recipe) {
  std::vector<Problem> warnings;
  for (const Json& json : list) {
    warnings.push_back(
        {Severity::Warning,
         json.at("code").get<std::string>(),
         {file_described(json.at("file"), recipe), json.at("pointer").get<std::string>(), 0, 0},
         json.at("message").get<std::string>(),
         json.at("hint").get<std::string>()});
  }
  return warnings;
}

}  // namespace

std::optional<KeptStage> BakeCache::find(const StageKey& stage) const {
  if (!is_on()) return {};
  std::optional<CacheEntry> entry = cache_.find(stage.key, observer_);
  if (!entry) return {};
  try {
    const Json both = parse_json(entry->facts, stage.name, {entry->facts.size()});
    entry->facts = both.at("facts").dump();
    return KeptStage{std::move(*entry), warnings_of(both.at("warnings"), recipe_)};
  } catch (const Json::exception&) {  // whole, but of another kind: whoever wrote it, it was not us
    return {};
  }
}

void BakeCache::take(const StageKey& stage, const std::vector<Problem>& warnings,
                     const Observer& observer) {
  taken_.push_back(stage.name);
  for (const Problem& warning : warnings) report(observer, warning);
}

std::optional<double> BakeCache::seconds_of(const StageKey& stage) const {
  const auto found = seconds_.find(stage.key);
  return found == seconds_.end() ? std::nullopt : std::optional(found->second);
}

void BakeCache::keep(const StageKey& stage, CacheEntry entry, const std::vector<Problem>& warnings,
                     double seconds) {
  seconds_[stage.key] = seconds;
  if (!keeps_) return;
  const Json facts = parse_json(entry.facts, stage.name, {entry.facts.size()});
  entry.facts = Json({{"facts", facts}, {"warnings", to_json(warnings, recipe_)}}).dump();
  try {
    cache_.keep(stage.key, entry);
  } catch (const BakeError& error) {
    keeps_ = false;
    const Problem& problem = error.problems().front();
    report(observer_, Problem{Severity::Warning, "cache.unwritable", problem.location,
                              "the cache keeps nothing: " + problem.message,
                              "the bake goes on without; choose another folder with --cache"});
  }
}

}  // namespace morphbake
