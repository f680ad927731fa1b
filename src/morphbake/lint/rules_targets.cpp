#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "morphbake/lint/rules.h"

namespace morphbake {
namespace {

std::vector<Fault> check_target_count(const LintSubject& at) {
  const std::optional<int> most = most_targets(at.profile, at.facts.has_normals);
  if (!most || at.facts.targets <= *most) return {};
  const char* kind = at.facts.has_normals ? " with NORMAL" : "";
  return {{at.survey.mesh_pointer,
           fmt::format("{} morph targets{}; {} reads at most {}", at.facts.targets, kind,
                       at.profile.title, *most),
           fmt::format("bake fewer targets: at most {}", *most)}};
}

std::vector<Fault> check_active(const LintSubject& at) {
  if (!at.profile.most_active || at.facts.most_active <= *at.profile.most_active) return {};
  return {{at.survey.mesh_pointer,
           fmt::format("{} targets are active at {:.4g} s; {} shows at most {} at a time",
                       at.facts.most_active, at.facts.most_active_time, at.profile.title,
                       *at.profile.most_active),
           "targets that are key frames have two active at any time"}};
}

std::set<std::string> names_of(const std::vector<StoredAttribute>& attributes) {
  std::set<std::string> names;
  for (const StoredAttribute& attribute : attributes) names.insert(attribute.name);
  return names;
}

/// What clients keep in one list for all targets of a mesh.
constexpr std::array<std::string_view, 4> kListed = {"POSITION", "NORMAL", "TANGENT", "COLOR_0"};

std::set<std::string> listed_of(const std::vector<StoredAttribute>& attributes) {
  std::set<std::string> names = names_of(attributes);
  std::erase_if(names, [](const std::string& name) {
    return std::ranges::find(kListed, name) == kListed.end();
  });
  return names;
}

std::string list_of(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "nothing" : list;
}

std::string target_pointer(const StoredPrimitive& primitive, std::size_t target) {
  return fmt::format("{}/targets/{}", primitive.pointer, target);
}

std::vector<Fault> check_equal_attributes(const LintSubject& at) {
  std::vector<Fault> faults;
  std::set<std::string> all;
  for (const StoredPrimitive& primitive : at.survey.primitives) {
    for (const auto& target : primitive.targets) all.merge(listed_of(target));
  }
  for (const StoredPrimitive& primitive : at.survey.primitives) {
    for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
      const std::set<std::string> own = listed_of(primitive.targets[t]);
      if (own == all) continue;
      faults.push_back({target_pointer(primitive, t),
                        fmt::format("the target moves {}, others {}", list_of(own), list_of(all)),
                        "give each target of the mesh the same attributes: some clients read "
                        "those of the first one only, and mix up the others"});
    }
  }
  return first_of(std::move(faults));
}

std::vector<Fault> check_base_attributes(const LintSubject& at) {
  std::vector<Fault> faults;
  for (const StoredPrimitive& primitive : at.survey.primitives) {
    const std::set<std::string> base = names_of(primitive.attributes);
    for (const auto& target : primitive.targets) {
      for (const StoredAttribute& attribute : target) {
        if (base.contains(attribute.name)) continue;
        faults.push_back(
            {attribute.pointer,
             fmt::format("the target moves {}, which the primitive does not have", attribute.name),
             "a target may only move what its primitive has"});
      }
    }
  }
  return first_of(std::move(faults));
}

std::vector<Fault> check_any_target(const LintSubject& at) {
  if (at.facts.targets > 0) return {};
  return {{at.survey.mesh_pointer, "the mesh has no morph targets",
           "choose another node by --node if one is meant"}};
}

/// The accessor of a primitive's positions, which primitives may share.
int position_accessor(const StoredPrimitive& primitive) {
  const auto found =
      std::ranges::find(primitive.attributes, std::string("POSITION"), &StoredAttribute::name);
  return found->accessor.index;  // without any the mesh was not read
}

std::vector<Fault> check_unused_vertices(const LintSubject& at) {
  struct Use {
    std::string pointer;
    std::vector<bool> is_used;
  };

  std::map<int, Use> uses;  // by accessor
  for (std::size_t p = 0; p < at.survey.primitives.size(); ++p) {
    const AnimatedPrimitive& primitive = at.survey.mesh.primitives[p];
    Use& use = uses[position_accessor(at.survey.primitives[p])];
    if (use.pointer.empty()) use.pointer = at.survey.primitives[p].pointer;
    use.is_used.resize(static_cast<std::size_t>(primitive.positions.rows()), false);
    for (const int vertex : primitive.triangles.reshaped()) {
      use.is_used[static_cast<std::size_t>(vertex)] = true;
    }
  }
  std::vector<Fault> faults;
  for (const auto& [accessor, use] : uses) {
    const auto unused = std::ranges::count(use.is_used, false);
    if (unused == 0) continue;
    faults.push_back(
        {use.pointer,
         fmt::format("{} of {} vertices belong to no triangle", unused, use.is_used.size()),
         "leave them out: each takes room in every target, and some clients drop them"});
  }
  return first_of(std::move(faults));
}

constexpr CheckedRule kRules[] = {
    {{"too-many-targets", FindingSeverity::Error, "more morph targets than the client reads"},
     check_target_count},
    {{"too-many-active", FindingSeverity::Error,
      "more targets with weights other than 0 at one time than the client shows"},
     check_active},
    {{"unequal-attributes", FindingSeverity::Error,
      "a target without POSITION, NORMAL, TANGENT or COLOR_0 that another one of the mesh has"},
     check_equal_attributes},
    {{"attribute-without-base", FindingSeverity::Error,
      "a target that moves what its primitive does not have"},
     check_base_attributes},
    {{"no-targets", FindingSeverity::Note, "a mesh without morph targets"}, check_any_target},
    {{"unused-vertices", FindingSeverity::Warning, "vertices that belong to no triangle"},
     check_unused_vertices},
};

}  // namespace

std::span<const CheckedRule> target_rules() { return kRules; }

}  // namespace morphbake
