#include <fmt/core.h>

#include <map>

#include "morphbake/json/json.h"
#include "morphbake/lint/rules.h"

namespace morphbake {
namespace {

std::string name_pointer(const LintSubject& at, std::size_t target) {
  return fmt::format("{}/extras/targetNames/{}", at.survey.mesh_pointer, target);
}

/// The faults of all names of which `fault(name)` tells a message.
template <typename Test>
std::vector<Fault> faulty_names(const LintSubject& at, const Test& message,
                                const std::string& right) {
  std::vector<Fault> faults;
  const std::vector<std::string>& names = at.survey.mesh.target_names;
  for (std::size_t t = 0; t < std::min(names.size(), at.survey.name_count.value_or(0)); ++t) {
    const std::string found = message(names[t]);
    if (!found.empty()) faults.push_back({name_pointer(at, t), found, right});
  }
  return first_of(std::move(faults));
}

std::vector<Fault> check_count(const LintSubject& at) {
  const std::size_t count = at.survey.name_count.value_or(0);
  const auto targets = static_cast<std::size_t>(at.facts.targets);
  if (count == targets) return {};
  return {{at.survey.mesh_pointer + "/extras/targetNames",
           fmt::format("{} names for {} targets", count, targets),
           "write one name a target, which people and scripts find it by"}};
}

std::vector<Fault> check_empty(const LintSubject& at) {
  if (at.profile.empty_names) return {};
  return faulty_names(
      at,
      [&](const std::string& name) {
        return name.empty() ? "the name is empty, which stops " + at.profile.title : "";
      },
      "give each target a name");
}

std::vector<Fault> check_length(const LintSubject& at) {
  if (!at.profile.name_bytes) return {};
  const auto most = static_cast<std::size_t>(*at.profile.name_bytes);
  return faulty_names(
      at,
      [&](const std::string& name) -> std::string {
        if (name.size() <= most) return "";
        return fmt::format("the name {} has {} bytes; {} cuts it after {}", shown(Json(name)),
                           name.size(), at.profile.title, most);
      },
      fmt::format("names of at most {} bytes", most));
}

std::vector<Fault> check_characters(const LintSubject& at) {
  return faulty_names(
      at,
      [&](const std::string& name) -> std::string {
        const std::size_t found = name.find_first_of(at.profile.forbidden_in_names);
        if (found == std::string::npos) return "";
        return fmt::format("the name {} has a \"{}\", which {} replaces", shown(Json(name)),
                           name[found], at.profile.title);
      },
      fmt::format("names without any of: {}", at.profile.forbidden_in_names));
}

std::vector<Fault> check_unique(const LintSubject& at) {
  std::map<std::string, int> uses;
  return faulty_names(
      at,
      [&](const std::string& name) -> std::string {
        if (name.empty() || ++uses[name] == 1) return "";
        return fmt::format("the name {} is there before", shown(Json(name)));
      },
      "name each target differently: clients that look them up find one of them only");
}

constexpr CheckedRule kRules[] = {
    {{"empty-name", FindingSeverity::Error, "targets called \"\", where that stops the client"},
     check_empty},
    {{"long-name", FindingSeverity::Error, "names that are longer than the client keeps"},
     check_length},
    {{"name-characters", FindingSeverity::Error, "names with characters that the client replaces"},
     check_characters},
    {{"double-name", FindingSeverity::Warning, "targets with the name of another one"},
     check_unique},
    {{"missing-names", FindingSeverity::Note,
      "extras.targetNames missing, or not one name a target"},
     check_count},
};

}  // namespace

std::span<const CheckedRule> name_rules() { return kRules; }

}  // namespace morphbake
