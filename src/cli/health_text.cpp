#include "cli/health_text.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include "morphbake/diagnostics/counted.h"

namespace morphbake::cli {
namespace {

std::string places_text(const HealthFinding& finding) {
  std::vector<std::string> places;
  for (const HealthPlace& place : finding.places) {
    const auto& at = place.position;
    places.push_back(fmt::format("triangle {} at ({:.4g}, {:.4g}, {:.4g})", place.triangle, at(0),
                                 at(1), at(2)));
  }
  const bool are_all = static_cast<std::size_t>(finding.count) == places.size();
  return fmt::format("{}{}", are_all ? "" : "first ", fmt::join(places, ", "));
}

/// How a finding is told.
struct Wording {
  const char* kind;  ///< what a bake does: "mended", "warning", "refused"
  const char* one;
  const char* several;
  const char* hint;
};

constexpr const char* kMerge = "in Blender: Mesh > Clean Up > Merge by Distance";
constexpr const char* kNonManifold =
    "in Blender: Mesh > Clean Up > Merge by Distance, then Select > All by Trait > Non Manifold "
    "shows the places";

void add_lines(const HealthFinding& finding, const Wording& wording,
               std::vector<std::string>& lines) {
  if (finding.count == 0) return;
  lines.push_back(fmt::format("  {:<10}{}: {}", wording.kind,
                              counted(finding.count, wording.one, wording.several),
                              places_text(finding)));
  lines.push_back(fmt::format("  {:<10}{}", "", wording.hint));
}

std::string shape_text(const MeshHealth& health) {
  const std::string pieces = counted(health.components, "component", "components");
  if (health.triangles == health.degenerate_triangles.count) return "a bake refuses it: no surface";
  if (!health.genus) return fmt::format("a bake refuses it; {}", pieces);
  const int loops = *health.boundary_loops;
  const std::string border =
      loops == 0 ? "closed" : fmt::format("open ({})", counted(loops, "border", "borders"));
  return fmt::format("{}, {}, genus {}", border, pieces, *health.genus);
}

void add_self_intersections(const MeshHealth& health, std::vector<std::string>& lines) {
  if (health.is_refused()) return;
  if (!health.self_intersections) {
    lines.push_back(
        fmt::format("  {:<10}self-intersections: too many triangles lie in heaps to "
                    "look through them",
                    "unknown"));
    return;
  }
  const char* several = health.more_self_intersections
                            ? "pairs of triangles and more cut one another"
                            : "pairs of triangles cut one another";
  add_lines(*health.self_intersections,
            {"warning", "pair of triangles cuts one another", several,
             "a bake takes them; pull the parts apart where a morph shows them"},
            lines);
}

Json finding_json(const HealthFinding& finding) {
  Json places = Json::array();
  for (const HealthPlace& place : finding.places) {
    const auto& at = place.position;
    Json entry;
    entry["triangle"] = place.triangle;
    entry["position"] = {at(0), at(1), at(2)};
    places.push_back(entry);
  }
  Json json;
  json["count"] = finding.count;
  json["places"] = places;
  return json;
}

Json number_or_null(const std::optional<int>& number) { return number ? Json(*number) : Json(); }

}  // namespace

std::vector<std::string> health_lines(const MeshHealth& health) {
  std::vector<std::string> lines = {fmt::format("health      {}", shape_text(health))};
  std::string vertices = fmt::format("{} of {}", counted(health.welded_vertices, "point", "points"),
                                     counted(health.render_vertices, "vertex", "vertices"));
  if (health.unused_vertices > 0) {
    vertices += fmt::format("; {} of no triangle",
                            counted(health.unused_vertices, "vertex is", "vertices are"));
  }
  lines.push_back(fmt::format("  {:<10}{}", "welded", vertices));
  const std::size_t without_findings = lines.size();
  add_lines(health.crowded_edges,
            {"refused", "edge has more than two triangles", "edges have more than two triangles",
             kNonManifold},
            lines);
  add_lines(health.pinched_vertices,
            {"refused", "point joins parts that no edge joins",
             "points join parts that no edge joins", kNonManifold},
            lines);
  add_lines(health.twisted_pieces,
            {"refused", "piece has one side only", "pieces have one side only",
             "cut it where it is twisted"},
            lines);
  add_lines(health.degenerate_triangles,
            {"mended", "degenerate triangle is left out", "degenerate triangles are left out",
             "in Blender: Mesh > Clean Up > Degenerate Dissolve"},
            lines);
  add_lines(
      health.duplicate_triangles,
      {"mended", "duplicate triangle is left out", "duplicate triangles are left out", kMerge},
      lines);
  add_lines(health.turned_triangles,
            {"mended", "triangle is turned", "triangles are turned",
             "in Blender: Mesh > Normals > Recalculate Outside"},
            lines);
  add_lines(
      health.open_seams,
      {"warning", "border edge lies beside another", "border edges lie beside others", kMerge},
      lines);
  add_self_intersections(health, lines);
  if (lines.size() == without_findings && !health.is_refused()) {
    lines.push_back(fmt::format("  {:<10}{}", "mended", "nothing; nothing else to tell"));
  }
  return lines;
}

Json health_json(const MeshHealth& health) {
  Json json;
  json["is_refused"] = health.is_refused();
  json["render_vertices"] = health.render_vertices;
  json["unused_vertices"] = health.unused_vertices;
  json["welded_vertices"] = health.welded_vertices;
  json["triangles"] = health.triangles;
  json["components"] = health.components;
  json["boundary_loops"] = number_or_null(health.boundary_loops);
  json["genus"] = number_or_null(health.genus);
  json["degenerate_triangles"] = finding_json(health.degenerate_triangles);
  json["duplicate_triangles"] = finding_json(health.duplicate_triangles);
  json["turned_triangles"] = finding_json(health.turned_triangles);
  json["crowded_edges"] = finding_json(health.crowded_edges);
  json["pinched_vertices"] = finding_json(health.pinched_vertices);
  json["twisted_pieces"] = finding_json(health.twisted_pieces);
  json["open_seams"] = finding_json(health.open_seams);
  json["self_intersections"] =
      health.self_intersections ? finding_json(*health.self_intersections) : Json();
  return json;
}

}  // namespace morphbake::cli
