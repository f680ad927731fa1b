#include "morphbake/sources/common_landmarks.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/json/nearest.h"

namespace morphbake {
namespace {

constexpr std::size_t kFewest = 3;  // two points leave a turn about both open

int index_of(const SourceSurface& surface, const std::string& name) {
  const auto& names = surface.landmark_names;
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// All names, each once, in order of appearance.
std::vector<std::string> all_names(const std::vector<SourceSurface>& surfaces) {
  std::vector<std::string> names;
  for (const SourceSurface& surface : surfaces) {
    for (const std::string& name : surface.landmark_names) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

/// Where the landmarks of a source stand, or should.
Location place_of(const SourceSurface& surface, const SourceRef& ref) {
  return ref.landmarks_at.file.empty() ? Location{surface.file, ""} : ref.landmarks_at;
}

/// One problem for each source that lacks landmarks.
std::vector<Problem> missing_landmarks(const std::vector<SourceSurface>& surfaces,
                                       const std::vector<SourceRef>& refs,
                                       const std::vector<std::string>& names, Severity severity) {
  std::vector<Problem> problems;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const SourceSurface& surface = surfaces[s];
    std::vector<std::string> missing;
    for (const std::string& name : names) {
      if (index_of(surface, name) < 0) missing.push_back(name);
    }
    if (missing.empty()) continue;
    const bool is_error = severity == Severity::Error;
    problems.push_back({severity, "landmarks.missing", place_of(surface, refs[s]),
                        fmt::format("\"{}\" lacks landmarks that other sources have: {}",
                                    surface.name, name_list(missing)),
                        is_error
                            ? "`morphbake landmarks suggest` proposes landmarks of two sources"
                            : "they are left out; only landmarks of all sources guide the map"});
  }
  return problems;
}

/// The names that all surfaces have, in the first one's order.
std::vector<std::string> common_names(const std::vector<SourceSurface>& surfaces) {
  std::vector<std::string> common;
  for (const std::string& name : all_names(surfaces)) {
    const bool is_common =
        std::all_of(surfaces.begin(), surfaces.end(),
                    [&](const SourceSurface& surface) { return index_of(surface, name) >= 0; });
    if (is_common) common.push_back(name);
  }
  return common;
}

}  // namespace

std::vector<Problem> common_landmark_problems(const std::vector<SourceSurface>& surfaces,
                                              const std::vector<SourceRef>& refs) {
  const std::size_t common = common_names(surfaces).size();
  const Severity severity = common < kFewest ? Severity::Error : Severity::Warning;
  std::vector<Problem> problems = missing_landmarks(surfaces, refs, all_names(surfaces), severity);
  if (common >= kFewest) return problems;
  problems.insert(
      problems.begin(),
      Problem{
          Severity::Error, "landmarks.too-few", place_of(surfaces.front(), refs.front()),
          fmt::format("the sources have {} landmarks in common; {} are needed", common, kFewest),
          "name the same points on every source, or let `morphbake landmarks "
          "suggest` propose them"});
  return problems;
}

std::vector<SourceSurface> with_common_landmarks(std::vector<SourceSurface> surfaces,
                                                 const std::vector<SourceRef>& refs,
                                                 const Observer& observer) {
  const std::vector<std::string> common = common_names(surfaces);
  std::vector<Problem> problems = common_landmark_problems(surfaces, refs);
  if (common.size() < kFewest) throw BakeError(std::move(problems));
  for (const Problem& problem : problems) report(observer, problem);
  for (SourceSurface& surface : surfaces) {
    std::vector<SurfacePoint> points;
    for (const std::string& name : common) {
      points.push_back(surface.landmarks[static_cast<std::size_t>(index_of(surface, name))]);
    }
    surface.landmark_names = common;
    surface.landmarks = std::move(points);
  }
  return surfaces;
}

}  // namespace morphbake
