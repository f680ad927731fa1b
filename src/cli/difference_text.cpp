#include "cli/difference_text.h"

#include <fmt/core.h>

#include "morphbake/diagnostics/counted.h"

namespace morphbake::cli {
namespace {

constexpr std::size_t kClipWidth = 24;

std::string clip_name(const ClipDifference& clip) {
  return clip.is_rest ? "(at rest)" : clip.name_a.empty() ? "(no name)" : clip.name_a;
}

/// "1.2e-04 at 0.52 s, vertex 17 of primitive 0", or "none".
std::string place_text(const LargestDifference& largest, const std::string& amount) {
  if (largest.primitive < 0) return "none";
  return fmt::format("{} at {:.4g} s, vertex {} of primitive {}", amount, largest.time,
                     largest.vertex, largest.primitive);
}

std::string distance_text(const LargestDifference& largest, double diagonal) {
  const std::string share =
      diagonal > 0 ? fmt::format(" ({:.2e} of the diagonal)", largest.value / diagonal) : "";
  return place_text(largest, fmt::format("{:.3e}{}", largest.value, share));
}

void append_findings(const std::vector<Finding>& findings, bool differences,
                     std::vector<std::string>& lines) {
  for (const Finding& finding : findings) {
    if (finding.is_difference != differences) continue;
    lines.push_back(fmt::format("{:<11} {} [{}]", differences ? "different" : "note",
                                finding.message, finding.kind));
  }
}

std::string normals_allowed(const MeshDifference& mesh) {
  return mesh.allowed.normal_angle ? fmt::format("{:.3g} degrees", *mesh.allowed.normal_angle)
                                   : "any angle, since the weights are others: see --normals";
}

std::string shown_count(std::size_t count, const char* one, const char* several) {
  return counted(static_cast<int>(count), one, several);
}

void append_clip(const ClipDifference& clip, double diagonal, std::vector<std::string>& lines) {
  const LargestDifference& normal = clip.motion.normal;
  lines.push_back(fmt::format("clip        {:<{}} {}", clip_name(clip), kClipWidth,
                              shown_count(clip.motion.instants, "time", "times")));
  lines.push_back("  positions " + distance_text(clip.motion.position, diagonal));
  lines.push_back("  normals   " + place_text(normal, fmt::format("{:.3g} degrees", normal.value)));
}

void append_mesh(const MeshDifference& mesh, std::vector<std::string>& lines) {
  const auto vertices = static_cast<std::size_t>(mesh.vertices.distance.size());
  lines.push_back(fmt::format("mesh        {} of nodes {} and {}: {} compared",
                              mesh.name.empty() ? "(no name)" : mesh.name, mesh.node_a, mesh.node_b,
                              shown_count(vertices, "vertex", "vertices")));
  lines.push_back(fmt::format(
      "allowed     {:.3e} ({:.2e} of the diagonal), normals {}", mesh.allowed.distance,
      mesh.diagonal > 0 ? mesh.allowed.distance / mesh.diagonal : 0.0, normals_allowed(mesh)));
  lines.push_back(fmt::format("beyond      {}, {}",
                              shown_count(mesh.vertices_beyond, "vertex", "vertices"),
                              shown_count(mesh.normals_beyond, "normal", "normals")));
  for (const ClipDifference& clip : mesh.clips) append_clip(clip, mesh.diagonal, lines);
}

}  // namespace

std::vector<std::string> difference_lines(const FileDifference& difference) {
  std::vector<std::string> lines = {"first       " + difference.file_a,
                                    "second      " + difference.file_b};
  for (const MeshDifference& mesh : difference.meshes) append_mesh(mesh, lines);
  for (const bool differences : {false, true}) {
    append_findings(difference.findings, differences, lines);
    for (const MeshDifference& mesh : difference.meshes) {
      append_findings(mesh.findings, differences, lines);
    }
  }
  lines.push_back(is_same(difference) ? "same" : "different");
  return lines;
}

}  // namespace morphbake::cli
