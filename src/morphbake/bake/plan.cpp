#include "morphbake/bake/plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "morphbake/bake/kept_stages.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

/// A stage as it was at the last bake.
struct LastStage {
  Json description;
  std::optional<double> seconds;
};

using LastStages = std::map<std::string, LastStage>;

/// The entry that tells what a recipe's stages were: of the file, whatever it says.
StageKey memory_of(const Recipe& recipe) {
  const std::string file = std::filesystem::absolute(recipe.file).lexically_normal().string();
  return {"plan", "", content_hash("plan of " + file)};
}

LastStages last_stages(const Recipe& recipe, const BakeCache& cache) {
  LastStages last;
  const std::optional<KeptStage> kept = cache.find(memory_of(recipe));
  if (!kept) return last;
  try {
    const JsonLimits limits{kept->entry.facts.size()};
    for (const Json& stage : parse_json(kept->entry.facts, "plan", limits)) {
      LastStage& each = last[stage.at("name").get<std::string>()];
      each.description = stage.at("description");
      if (stage.contains("seconds")) each.seconds = stage["seconds"].get<double>();
    }
  } catch (const Json::exception&) {
    return {};
  }
  return last;
}

/// What a stage's result is for.
enum class Role {
  Before,   ///< other stages
  Result,   ///< what is written or reported: if all of these are kept, no other is needed
  Preview,  ///< pictures of what is written
};

struct KeptStageKey {
  StageKey stage;
  Role role;
};

/// Stages whose results are kept, in the order in which they run.
std::vector<KeptStageKey> kept_stages(const Recipe& recipe, const BakeKeys& keys) {
  std::vector<KeptStageKey> stages;
  const auto add = [&](const StageKey& stage, Role role) { stages.push_back({stage, role}); };
  if (recipe.connectivity.mode != ConnectivityMode::Shared) add(keys.connectivity, Role::Before);
  if (std::ranges::any_of(recipe.regions, is_worth_keeping)) add(keys.regions, Role::Before);
  if (!recipe.derived.empty()) add(keys.derived, Role::Before);
  add(keys.solve, Role::Result);
  for (const StageKey& output : keys.outputs) add(output, Role::Result);
  if (!recipe.preview) return stages;
  for (const StageKey& preview : keys.previews) add(preview, Role::Preview);
  if (!recipe.preview->maps.empty()) add(keys.maps, Role::Result);
  return stages;
}

/// One change of a description, in words.
std::string words_of(const Json& change, const Json& before, const Json& now) {
  const auto pointer = change.at("path").get<std::string>();
  if (pointer == "/program") return "another build of morphbake made it";
  if (pointer == "/connectivity" && now["connectivity"].is_string()) {
    return "the sources or the connectivity changed";
  }
  if (pointer == "/solve" || pointer == "/of") return "what it is made from changed";
  const std::size_t file = pointer.find("/file");
  if (pointer.starts_with("/sources/") && file != std::string::npos) {
    return fmt::format("a file of {} has other bytes", pointer.substr(0, file));
  }
  const std::string place = pointer.starts_with("/recipe/") ? pointer.substr(7) : pointer;
  if (change["op"] == "add") return fmt::format("{} is new: {}", place, shown(change["value"]));
  if (change["op"] == "remove") return fmt::format("{} is there no more", place);
  return fmt::format("{} was {} and is {}", place, shown(before.at(Json::json_pointer(pointer))),
                     shown(change["value"]));
}

/// In what two descriptions differ, as far as one wants to read it.
std::string differences(const Json& before, const Json& now) {
  constexpr std::size_t kTold = 3;
  const Json changes = Json::diff(before, now);
  if (changes.empty()) return "its entry is gone: it was removed, or made room for others";
  std::string words;
  for (std::size_t i = 0; i < changes.size() && i < kTold; ++i) {
    words += (i > 0 ? "; " : "") + words_of(changes[i], before, now);
  }
  return changes.size() > kTold ? words + "; and more" : words;
}

std::string reason_for(const StageKey& stage, const LastStages& last) {
  if (last.empty()) return "the cache knows no bake of this recipe";
  const auto before = last.find(stage.name);
  if (before == last.end()) return "the last bake of this recipe did not have it";
  const Json now = parse_json(stage.description, stage.name, {stage.description.size()});
  return "since the last bake " + differences(before->second.description, now);
}

}  // namespace

std::vector<PlannedStage> plan(const Recipe& recipe, const BakeOptions& options,
                               const BakeCache& cache) {
  InputFiles files;
  const std::vector<KeptStageKey> stages = kept_stages(recipe, bake_keys(recipe, options, files));
  const bool results_are_kept = std::ranges::all_of(stages, [&](const KeptStageKey& each) {
    return each.role != Role::Result || cache.contains(each.stage);
  });
  const LastStages last = last_stages(recipe, cache);
  std::vector<PlannedStage> planned;
  for (const auto& [stage, role] : stages) {
    PlannedStage each{stage.name, PlannedState::Runs, {}, ""};
    const auto before = last.find(stage.name);
    if (before != last.end()) each.seconds = before->second.seconds;
    if (results_are_kept && role == Role::Before) {
      each.state = PlannedState::Unneeded;
    } else if (cache.contains(stage)) {
      each.state = PlannedState::Cached;
    } else {
      each.reason = reason_for(stage, last);
    }
    planned.push_back(std::move(each));
  }
  return planned;
}

void remember_plan(const Recipe& recipe, const BakeKeys& keys, BakeCache& cache) {
  const LastStages last = last_stages(recipe, cache);
  Json memory = Json::array();
  for (const auto& [stage, role] : kept_stages(recipe, keys)) {
    const JsonLimits limits{stage.description.size()};
    Json json = {{"name", stage.name},
                 {"description", parse_json(stage.description, stage.name, limits)}};
    std::optional<double> seconds = cache.seconds_of(stage);
    const auto before = last.find(stage.name);
    if (!seconds && before != last.end()) seconds = before->second.seconds;
    if (seconds) json["seconds"] = *seconds;
    memory.push_back(std::move(json));
  }
  cache.keep(memory_of(recipe), {memory.dump(), {}}, {}, 0);
}

std::string plan_to_json(const std::vector<PlannedStage>& stages) {
  constexpr const char* kStates[] = {"cached", "runs", "unneeded"};
  Json list = Json::array();
  for (const PlannedStage& stage : stages) {
    Json json = {{"name", stage.name}, {"state", kStates[static_cast<int>(stage.state)]}};
    if (stage.seconds) json["seconds"] = *stage.seconds;
    if (!stage.reason.empty()) json["reason"] = stage.reason;
    list.push_back(std::move(json));
  }
  return list.dump(2);
}

}  // namespace morphbake
