#include "morphbake/sources/common_landmarks.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/json/nearest.h"

namespace morphbake {
namespace {

bool has_landmark(const SourceRef& source, const std::string& name) {
  return std::any_of(source.landmarks.begin(), source.landmarks.end(),
                     [&](const Landmark& landmark) { return landmark.name == name; });
}

/// All names, each once, in order of appearance.
std::vector<std::string> all_names(const std::vector<SourceRef>& sources) {
  std::vector<std::string> names;
  for (const SourceRef& source : sources) {
    for (const Landmark& landmark : source.landmarks) {
      if (std::find(names.begin(), names.end(), landmark.name) == names.end()) {
        names.push_back(landmark.name);
      }
    }
  }
  return names;
}

/// Where the landmarks of a source stand, or should.
Location place_of(const SourceRef& source) {
  return source.landmarks_at.file.empty() ? Location{source.file.string(), ""}
                                          : source.landmarks_at;
}

/// One problem for each source that lacks landmarks.
std::vector<Problem> missing_landmarks(const std::vector<SourceRef>& sources, Severity severity) {
  const std::vector<std::string> names = all_names(sources);
  std::vector<Problem> problems;
  for (const SourceRef& source : sources) {
    std::vector<std::string> missing;
    for (const std::string& name : names) {
      if (!has_landmark(source, name)) missing.push_back(name);
    }
    if (missing.empty()) continue;
    const bool is_error = severity == Severity::Error;
    problems.push_back({severity, "landmarks.missing", place_of(source),
                        fmt::format("\"{}\" lacks landmarks that other sources have: {}",
                                    source.name, name_list(missing)),
                        is_error
                            ? "`morphbake landmarks suggest` proposes landmarks of two sources"
                            : "they are left out; only landmarks of all sources guide the map"});
  }
  return problems;
}

}  // namespace

std::vector<std::string> common_landmark_names(const std::vector<SourceRef>& sources) {
  std::vector<std::string> common;
  for (const Landmark& landmark : sources.front().landmarks) {
    const bool is_common =
        std::all_of(sources.begin(), sources.end(),
                    [&](const SourceRef& source) { return has_landmark(source, landmark.name); });
    if (is_common) common.push_back(landmark.name);
  }
  return common;
}

std::vector<Problem> common_landmark_problems(const std::vector<SourceRef>& sources) {
  const std::size_t common = common_landmark_names(sources).size();
  const bool is_enough = common >= kFewestLandmarks;
  std::vector<Problem> problems =
      missing_landmarks(sources, is_enough ? Severity::Warning : Severity::Error);
  if (is_enough) return problems;
  problems.insert(problems.begin(),
                  Problem{Severity::Error, "landmarks.too-few", place_of(sources.front()),
                          fmt::format("the sources have {} landmarks in common; {} are needed",
                                      common, kFewestLandmarks),
                          "name the same points on every source, or let `morphbake landmarks "
                          "suggest` propose them"});
  return problems;
}

std::vector<SourceSurface> with_common_landmarks(std::vector<SourceSurface> surfaces,
                                                 const std::vector<SourceRef>& sources,
                                                 const Observer& observer) {
  const std::vector<std::string> common = common_landmark_names(sources);
  std::vector<Problem> problems = common_landmark_problems(sources);
  if (common.size() < kFewestLandmarks) throw BakeError(std::move(problems));
  for (const Problem& problem : problems) report(observer, problem);
  for (SourceSurface& surface : surfaces) {
    std::vector<SurfacePoint> points;
    for (const std::string& name : common) {
      const auto& names = surface.landmark_names;
      const auto found = std::find(names.begin(), names.end(), name);
      points.push_back(surface.landmarks[static_cast<std::size_t>(found - names.begin())]);
    }
    surface.landmark_names = common;
    surface.landmarks = std::move(points);
  }
  return surfaces;
}

}  // namespace morphbake
