#include "cli/lint_text.h"

#include <fmt/core.h>

#include "morphbake/diagnostics/counted.h"
#include "morphbake/diagnostics/shown_text.h"

namespace morphbake::cli {
namespace {

std::string shown_box(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d &low = box.min(), &high = box.max();
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})", low.x(), low.y(),
                     low.z(), high.x(), high.y(), high.z());
}

std::string title_of(const Profile& profile) {
  const std::string version = profile.version.empty() ? "" : " " + profile.version;
  const char* known = profile.evidence == Evidence::Client
                          ? "run by morphbake's tests"
                          : "from its documentation and sources only";
  const std::string& client = profile.client.empty() ? profile.title : profile.client;
  return fmt::format("{}{}, {}", client, version, known);
}

void add_mesh(const LintedMesh& mesh, std::vector<std::string>& lines) {
  const std::string name = mesh.node_name.empty() ? "" : fmt::format(" \"{}\"", mesh.node_name);
  lines.push_back(fmt::format("mesh        of {}{}: {}, {} vertices", mesh.node_pointer, name,
                              counted(mesh.primitives, "primitive", "primitives"), mesh.vertices));
  const char* normals = mesh.has_normals ? " with NORMAL" : "";
  lines.push_back(fmt::format("targets     {}{}; {} active at one time, at {:.4g} s", mesh.targets,
                              normals, mesh.most_active, mesh.most_active_time));
  lines.push_back("bounds      " + shown_box(mesh.rest));
  const char* sampled = mesh.is_motion_sampled ? ", which are some of all" : "";
  lines.push_back(fmt::format("in motion   {}, over {}{}", shown_box(mesh.motion),
                              counted(mesh.motion_poses, "pose", "poses"), sampled));
  if (mesh.targets > 0) lines.push_back("GPU         " + shown_memory(mesh.gpu));
}

/// "255", "8 / 4": most targets, and with normals where that differs.
std::string limit_of(const Profile& profile) {
  if (!profile.most_targets) return "any";
  const int plain = *profile.most_targets;
  const int with_normals = profile.most_targets_with_normals.value_or(plain);
  return plain == with_normals ? fmt::format("{}", plain)
                               : fmt::format("{} / {}", plain, with_normals);
}

std::string yes(bool is_read) { return is_read ? "yes" : "no"; }

std::string sparse_of(const Profile& profile) {
  if (profile.sparse == SparseSupport::WithView) return "view";
  return yes(profile.sparse == SparseSupport::Any);
}

}  // namespace

std::string shown_memory(const std::vector<GpuMemory>& memory) {
  std::string text;
  for (const GpuMemory& each : memory) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", each.profile, shown_bytes(each.bytes));
  }
  return text;
}

std::vector<std::string> lint_lines(const LintReport& report, const Profile& profile,
                                    bool hides_notes) {
  std::vector<std::string> lines;
  lines.push_back("file        " + report.file);
  lines.push_back(fmt::format("profile     {} ({})", profile.name, title_of(profile)));
  for (const LintedMesh& mesh : report.meshes) add_mesh(mesh, lines);
  for (const Finding& finding : report.findings) {
    if (hides_notes && finding.severity == FindingSeverity::Note) continue;
    lines.push_back(
        fmt::format("{:<11} {} [{}]", name_of(finding.severity), finding.message, finding.rule));
    lines.push_back(fmt::format("            at #{}", finding.pointer));
    lines.push_back(fmt::format("            hint: {}", finding.right));
  }
  lines.push_back(
      fmt::format("{}, {}, {}", counted(count(report, FindingSeverity::Error), "error", "errors"),
                  counted(count(report, FindingSeverity::Warning), "warning", "warnings"),
                  counted(count(report, FindingSeverity::Note), "note", "notes")));
  for (std::string& line : lines) line = without_control_characters(line);
  return lines;
}

std::vector<std::string> rule_lines() {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{:<12} {:>8}  {:<6} {:<9} {:<7} {}", "profile", "targets", "sparse",
                              "quantized", "meshopt", "known from"));
  for (const Profile& profile : shipped_profiles()) {
    lines.push_back(fmt::format(
        "{:<12} {:>8}  {:<6} {:<9} {:<7} {}", profile.name, limit_of(profile), sparse_of(profile),
        yes(profile.mesh_quantization), yes(profile.meshopt_compression), title_of(profile)));
  }
  lines.emplace_back();
  lines.push_back(fmt::format("{:<24} {:<8} {}", "rule", "severity", "finds"));
  for (const LintRule& rule : lint_rules()) {
    lines.push_back(
        fmt::format("{:<24} {:<8} {}", rule.code, name_of(rule.severity), rule.meaning));
  }
  return lines;
}

}  // namespace morphbake::cli
