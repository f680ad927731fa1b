#include "morphbake/lint/lint.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "morphbake/json/json.h"
#include "morphbake/lint/motion_facts.h"
#include "morphbake/lint/rules.h"

namespace morphbake {
namespace {

constexpr std::array kTables = {target_rules, encoding_rules, quantization_rules, weights_rules,
                                name_rules};

LintedMesh find_facts(const MeshSurvey& survey, const Observer& observer) {
  LintedMesh facts;
  facts.node_pointer = survey.node_pointer;
  facts.node_name = survey.node_name;
  facts.primitives = static_cast<int>(survey.primitives.size());
  facts.targets = static_cast<int>(survey.mesh.target_names.size());
  facts.has_normals = morphs(survey, "NORMAL");
  for (const AnimatedPrimitive& primitive : survey.mesh.primitives) {
    facts.vertices += primitive.positions.rows();
  }
  find_active(survey, facts);
  find_bounds(survey, facts, observer);
  return facts;
}

TargetVertices target_rows(const AnimatedMesh& mesh) {
  TargetVertices rows;
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    const auto& normals = primitive.target_normals;
    const bool has_normals =
        std::ranges::any_of(normals, [](const Float3s& normal) { return normal.rows() > 0; });
    const auto count = static_cast<double>(primitive.positions.rows()) *
                       static_cast<double>(primitive.target_positions.size());
    (has_normals ? rows.with_normals : rows.plain) += count;
  }
  return rows;
}

void check_mesh(const LintSubject& subject, std::vector<Finding>& findings) {
  for (const auto& table : kTables) {
    for (const CheckedRule& checked : table()) {
      for (Fault& fault : checked.check(subject)) {
        Finding finding{checked.rule.severity, checked.rule.code, std::move(fault.pointer),
                        std::move(fault.message), std::move(fault.right)};
        // Of the file as a whole each mesh finds the same.
        const bool is_new = std::ranges::find(findings, finding) == findings.end();
        if (is_new) findings.push_back(std::move(finding));
      }
    }
  }
}

Json to_json(const Eigen::AlignedBox3d& box) {
  const auto point = [](const Eigen::Vector3d& p) { return Json{p.x(), p.y(), p.z()}; };
  return {{"min", point(box.min())}, {"max", point(box.max())}};
}

Json to_json(const LintedMesh& mesh) {
  Json json;
  json["node"] = mesh.node_pointer;
  json["name"] = mesh.node_name;
  json["primitives"] = mesh.primitives;
  json["vertices"] = mesh.vertices;
  json["targets"] = mesh.targets;
  json["normals"] = mesh.has_normals;
  json["most_active"] = mesh.most_active;
  json["most_active_time"] = mesh.most_active_time;
  json["bounds"] = to_json(mesh.rest);
  json["motion_bounds"] = to_json(mesh.motion);
  json["motion_poses"] = mesh.motion_poses;
  json["motion_sampled"] = mesh.is_motion_sampled;
  json["gpu"] = Json::array();
  for (const GpuMemory& memory : mesh.gpu) {
    json["gpu"].push_back({{"profile", memory.profile}, {"bytes", std::llround(memory.bytes)}});
  }
  return json;
}

Json to_json(const Finding& finding) {
  return {{"severity", name_of(finding.severity)},
          {"rule", finding.rule},
          {"pointer", finding.pointer},
          {"message", finding.message},
          {"right", finding.right}};
}

}  // namespace

const char* name_of(FindingSeverity severity) {
  if (severity == FindingSeverity::Note) return "note";
  return severity == FindingSeverity::Warning ? "warning" : "error";
}

std::vector<Fault> first_of(std::vector<Fault> faults) {
  if (faults.size() < 2) return faults;
  faults.front().message += fmt::format(" ({} places in all)", faults.size());
  faults.resize(1);
  return faults;
}

bool morphs(const MeshSurvey& survey, std::string_view attribute) {
  return std::ranges::any_of(target_attributes(survey), [&](const StoredAttribute* found) {
    return found->name == attribute;
  });
}

std::vector<const StoredAttribute*> target_attributes(const MeshSurvey& survey) {
  std::vector<const StoredAttribute*> attributes;
  for (const StoredPrimitive& primitive : survey.primitives) {
    for (const auto& target : primitive.targets) {
      for (const StoredAttribute& attribute : target) attributes.push_back(&attribute);
    }
  }
  return attributes;
}

std::vector<const StoredAttribute*> all_attributes(const MeshSurvey& survey) {
  std::vector<const StoredAttribute*> attributes;
  for (const StoredPrimitive& primitive : survey.primitives) {
    for (const StoredAttribute& attribute : primitive.attributes) attributes.push_back(&attribute);
  }
  std::ranges::copy(target_attributes(survey), std::back_inserter(attributes));
  return attributes;
}

std::vector<LintRule> lint_rules() {
  std::vector<LintRule> rules;
  for (const auto& table : kTables) {
    for (const CheckedRule& checked : table()) rules.push_back(checked.rule);
  }
  return rules;
}

std::vector<GpuMemory> gpu_memory(const std::vector<Profile>& profiles, const AnimatedMesh& mesh) {
  const TargetVertices rows = target_rows(mesh);
  std::vector<GpuMemory> memory;
  for (const Profile& profile : profiles) {
    const auto bytes = gpu_bytes(profile, rows);
    if (bytes) memory.push_back({profile.name, *bytes});
  }
  return memory;
}

LintReport lint(const GltfFile& file, const Profile& profile, const MeshChoice& choice,
                const LintOptions& options, const Observer& observer) {
  LintReport report;
  report.file = file_of(file);
  report.profile = profile.name;
  const std::vector<Profile> profiles = shipped_profiles();
  for (const MeshSurvey& survey : survey_meshes(file, choice)) {
    stop_if_cancelled(observer);
    LintedMesh& facts = report.meshes.emplace_back(find_facts(survey, observer));
    facts.gpu = gpu_memory(profiles, survey.mesh);
    check_mesh({survey, report.meshes.back(), profile, options}, report.findings);
  }
  return report;
}

int count(const LintReport& report, FindingSeverity severity) {
  return static_cast<int>(std::ranges::count(report.findings, severity, &Finding::severity));
}

std::string lint_to_json(const LintReport& report) {
  Json json;
  json["file"] = report.file;
  json["profile"] = report.profile;
  for (const FindingSeverity severity :
       {FindingSeverity::Error, FindingSeverity::Warning, FindingSeverity::Note}) {
    json[std::string(name_of(severity)) + "s"] = count(report, severity);
  }
  json["findings"] = Json::array();
  for (const Finding& finding : report.findings) json["findings"].push_back(to_json(finding));
  json["meshes"] = Json::array();
  for (const LintedMesh& mesh : report.meshes) json["meshes"].push_back(to_json(mesh));
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace morphbake
