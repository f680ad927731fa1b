#pragma once

// Internal to lint/: what the rules look at, and their tables.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "morphbake/gltf/mesh_survey.h"
#include "morphbake/lint/lint.h"

namespace morphbake {

/// What a rule judges: a mesh, for a client.
struct LintSubject {
  const MeshSurvey& survey;
  const LintedMesh& facts;
  const Profile& profile;
  const LintOptions& options;
};

/// A place where a rule is broken.
struct Fault {
  std::string pointer;
  std::string message;
  std::string right;
};

/// A rule and how it is checked.
struct CheckedRule {
  LintRule rule;
  std::vector<Fault> (*check)(const LintSubject&);
};

/// Of targets and vertices, of how numbers are stored, of animations, of names.
std::span<const CheckedRule> target_rules();
std::span<const CheckedRule> encoding_rules();
std::span<const CheckedRule> quantization_rules();
std::span<const CheckedRule> weights_rules();
std::span<const CheckedRule> name_rules();

/// Of many faults alike the first one, which tells their number; nothing of none.
std::vector<Fault> first_of(std::vector<Fault> faults);

/// Whether any target of the mesh has an attribute.
bool morphs(const MeshSurvey& survey, std::string_view attribute);

/// All attributes of primitives and targets, in the file's order.
std::vector<const StoredAttribute*> all_attributes(const MeshSurvey& survey);

/// Those of targets alone.
std::vector<const StoredAttribute*> target_attributes(const MeshSurvey& survey);

}  // namespace morphbake
