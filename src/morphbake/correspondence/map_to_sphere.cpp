#include <fmt/core.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "morphbake/correspondence/capped_surface.h"
#include "morphbake/correspondence/check_map.h"
#include "morphbake/correspondence/pin_landmarks.h"
#include "morphbake/correspondence/source_topology.h"
#include "morphbake/correspondence/sphere_layout.h"
#include "morphbake/correspondence/spherical_map.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

/// Levels at which landmarks are tried to be pinned: few vertices let them travel far, more give
/// each of them room.
constexpr int kPinLevels[] = {250, 600, 1500};
constexpr int kSteps = 4;  // of the progress bar

Problem problem_of(const SourceSurface& source, const std::string& code, std::string message,
                   std::string hint) {
  return {Severity::Error, code, {source.file, "", 0, 0}, std::move(message), std::move(hint)};
}

[[noreturn]] void fail(const SourceSurface& source, const std::string& code,
                       const std::string& message, const std::string& hint) {
  throw BakeError(problem_of(source, code, message, hint));
}

/// A landmark on the border of one source lies on the border of all.
void add_off_border(const std::vector<SourceSurface>& sources,
                    const std::vector<CappedSurface>& capped, std::vector<Problem>& problems) {
  for (std::size_t l = 0; l < sources[0].landmarks.size(); ++l) {
    const auto is_on_border = [&](std::size_t s) {
      return capped[s].on_boundary[static_cast<std::size_t>(capped[s].landmarks[l])] != 0;
    };
    for (std::size_t s = 1; s < sources.size(); ++s) {
      if (is_on_border(s) == is_on_border(0)) continue;
      const std::size_t on = is_on_border(s) ? s : 0, off = is_on_border(s) ? 0 : s;
      problems.push_back(problem_of(
          sources[off], "correspondence.landmark-off-border",
          fmt::format("landmark \"{}\" lies on the border of \"{}\" but inside of \"{}\"",
                      sources[0].landmark_names[l], sources[on].name, sources[off].name),
          "move it onto the border of both, or inside of both"));
    }
  }
}

/// Different landmarks must be different vertices.
void add_not_distinct(const SourceSurface& source, const CappedSurface& capped,
                      std::vector<Problem>& problems) {
  for (std::size_t l = 0; l < capped.landmarks.size(); ++l) {
    for (std::size_t k = 0; k < l; ++k) {
      if (capped.landmarks[k] != capped.landmarks[l]) continue;
      problems.push_back(
          problem_of(source, "correspondence.same-landmark",
                     fmt::format("landmarks \"{}\" and \"{}\" of \"{}\" are one point",
                                 source.landmark_names[k], source.landmark_names[l], source.name),
                     "move or remove one of them"));
    }
  }
}

/// The sources closed, with all that is wrong about them told at once.
std::vector<CappedSurface> cap_all(const std::vector<SourceSurface>& sources,
                                   const Observer& observer) {
  std::vector<Problem> problems = topology_problems(sources);
  if (!problems.empty()) throw BakeError(std::move(problems));
  std::vector<CappedSurface> capped;
  for (const SourceSurface& source : sources) {
    stop_if_cancelled(observer);
    capped.push_back(cap_surface(source));
  }
  stop_if_cancelled(observer);
  add_off_border(sources, capped, problems);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    add_not_distinct(sources[s], capped[s], problems);
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return capped;
}

/// The one of two closed surfaces that is inside out, which makes it look mirrored; null when that
/// is neither or both.
const SourceSurface* inside_out(const SourceSurface& first, const SourceSurface& other) {
  const auto is_turned = [](const Mesh& mesh) {
    return enclosed_volume(mesh.positions, mesh.triangles) < 0;
  };
  const bool is_first = is_turned(first.mesh), is_other = is_turned(other.mesh);
  if (is_first == is_other) return nullptr;
  return is_first ? &first : &other;
}

[[noreturn]] void fail_mirrored(const SourceSurface& first, const SourceSurface& other,
                                bool is_closed, const std::string& fits) {
  const SourceSurface* turned = is_closed ? inside_out(first, other) : nullptr;
  if (turned != nullptr) {
    fail(*turned, "correspondence.mirrored",
         fmt::format("\"{}\" is inside out: the landmarks of \"{}\" fit to those of \"{}\" {}",
                     turned->name, other.name, first.name, fits),
         "in Blender: Mesh > Normals > Recalculate Outside");
  }
  fail(other, "correspondence.mirrored",
       fmt::format("\"{}\" is a mirror image of \"{}\": its landmarks fit {}", other.name,
                   first.name, fits),
       "swap its left and right landmarks, or mirror the mesh");
}

/// Landmarks that fit far better after a reflection belong to a mirror image.
void check_not_mirrored(const std::vector<SourceSurface>& sources,
                        const std::vector<SphereLayout>& layouts) {
  constexpr double kClearlyOff = 0.35;  // radians
  for (std::size_t s = 1; s < layouts.size(); ++s) {
    const double straight = fit_rotation(layouts[s], layouts[0], false).residual;
    const double mirrored = fit_rotation(layouts[s], layouts[0], true).residual;
    if (straight < kClearlyOff || mirrored > 0.5 * straight) continue;
    fail_mirrored(sources[0], sources[s], layouts[s].surface->apex < 0,
                  fmt::format("to {:.0f} degrees as they are and to {:.0f} degrees mirrored",
                              straight * 57.29578, mirrored * 57.29578));
  }
}

/// A layout does not know whose it is.
std::vector<Problem> told_of(std::vector<Problem> problems, const SourceSurface& source) {
  for (Problem& problem : problems) {
    if (!problem.location.file.empty()) continue;
    problem.location.file = source.file;
    problem.message = fmt::format("\"{}\": {}", source.name, problem.message);
  }
  return problems;
}

template <typename Function>
void for_each_layout(const std::vector<SourceSurface>& sources, std::vector<SphereLayout>& layouts,
                     const Function& each) {
  tbb::parallel_for(std::size_t{0}, layouts.size(), [&](std::size_t s) {
    try {
      each(layouts[s]);
    } catch (const BakeError& error) {
      throw BakeError(told_of(error.problems(), sources[s]));
    }
  });
}

void check_coarse(const std::vector<SourceSurface>& sources,
                  const std::vector<SphereLayout>& layouts) {
  for (std::size_t s = 0; s < layouts.size(); ++s) {
    const int base = layouts[s].surface->apex < 0 ? 4 : 5;
    if (layouts[s].mesh.vertex_count() == base) continue;
    fail(sources[s], "correspondence.cannot-coarsen",
         fmt::format("\"{}\" cannot be simplified below {} vertices", sources[s].name,
                     layouts[s].mesh.vertex_count()),
         "remesh the source with more even triangles");
  }
}

/// All surfaces on one sphere at a coarse level with pinned landmarks.
std::vector<SphereLayout> lay_out(const std::vector<SourceSurface>& sources,
                                  const std::vector<CappedSurface>& capped,
                                  const Observer& observer) {
  std::vector<SphereLayout> coarse;
  for (const CappedSurface& surface : capped) {
    stop_if_cancelled(observer);
    coarse.push_back(make_layout(surface));
  }
  for_each_layout(sources, coarse, [&](SphereLayout& layout) {
    coarsen(layout, layout.surface->apex < 0 ? 4 : 5, {}, observer);
  });
  check_coarse(sources, coarse);
  advance(observer, {"correspondence", 1, kSteps});
  for_each_layout(sources, coarse, lie_down);
  const auto landmarks = static_cast<int>(sources[0].landmarks.size());
  std::vector<int> unpinned;
  bool is_mirror_checked = false;
  for (const int level : kPinLevels) {
    const int count = std::max(level, 10 * landmarks);
    for_each_layout(sources, coarse, [&](SphereLayout& layout) {
      refine(layout, count, observer);
      relax(layout, 60, observer);
    });
    if (!is_mirror_checked) check_not_mirrored(sources, coarse);
    is_mirror_checked = true;
    std::vector<SphereLayout> pinned = coarse;
    unpinned = pin_landmarks(pinned, observer);
    advance(observer, {"correspondence", 2, kSteps});
    if (unpinned.empty()) return pinned;
  }
  std::vector<std::string> names;
  for (const int l : unpinned) {
    names.push_back(fmt::format("\"{}\"", sources[0].landmark_names[static_cast<std::size_t>(l)]));
  }
  throw BakeError(Problem{
      Severity::Error,
      "correspondence.contradictory-landmarks",
      {sources[0].file, "", 0, 0},
      fmt::format("landmarks contradict one another: {} cannot be brought to one place on all "
                  "sources without folding one of them over",
                  fmt::join(names, ", ")),
      "look at them with `morphbake landmarks show`: one of them, or a neighbour of it, is named "
      "wrongly on some source (left for right, front for hind)"});
}

SphericalMap map_of(const SourceSurface& source, const CappedSurface& capped,
                    const SphereLayout& layout) {
  SphericalMap map;
  map.source_triangles = source.mesh.triangles;
  const Eigen::Index vertices = capped.positions.rows() - (capped.apex >= 0 ? 1 : 0);
  const Eigen::Index triangles = capped.triangles.rows() - capped.cap_triangles;
  map.surface = {capped.positions.topRows(vertices), capped.triangles.topRows(triangles)};
  map.on_source.assign(capped.on_source.begin(), capped.on_source.begin() + vertices);
  map.source_triangle = capped.source_triangle;
  map.sphere.resize(vertices, 3);
  for (Eigen::Index v = 0; v < vertices; ++v) {
    map.sphere.row(v) = layout.sphere[static_cast<std::size_t>(v)];
  }
  map.on_boundary.assign(capped.on_boundary.begin(), capped.on_boundary.begin() + vertices);
  map.landmarks = capped.landmarks;
  map.hard_edges = capped.hard_edges;
  return map;
}

/// What was promised is checked exactly, whatever happened on the way.
void verify(const std::vector<SourceSurface>& sources, const std::vector<SphericalMap>& maps,
            bool is_disk) {
  for (std::size_t s = 0; s < maps.size(); ++s) {
    const SphereCheck check = check_sphere(maps[s].sphere, maps[s].surface.triangles, is_disk);
    bool landmarks_meet = true, border_is_flat = true;
    for (std::size_t l = 0; l < maps[s].landmarks.size(); ++l) {
      landmarks_meet &=
          maps[s].sphere.row(maps[s].landmarks[l]) == maps[0].sphere.row(maps[0].landmarks[l]);
    }
    for (std::size_t v = 0; v < maps[s].on_boundary.size(); ++v) {
      border_is_flat &=
          !maps[s].on_boundary[v] || maps[s].sphere(static_cast<Eigen::Index>(v), 2) == 0;
    }
    if (check.turned == 0 && std::abs(check.degree - 1) < 1e-6 && landmarks_meet &&
        border_is_flat) {
      continue;
    }
    fail(sources[s], "correspondence.not-bijective",
         fmt::format(
             "\"{}\" could not be laid on the sphere: {} triangles are turned, it is covered "
             "{:.6f} times",
             sources[s].name, check.turned, check.degree),
         "remesh the source with more even triangles");
  }
}

}  // namespace

std::vector<SphericalMap> map_to_sphere(const std::vector<SourceSurface>& sources,
                                        const Observer& observer) {
  advance(observer, {"correspondence", 0, kSteps});
  const std::vector<CappedSurface> capped = cap_all(sources, observer);
  std::vector<SphereLayout> layouts = lay_out(sources, capped, observer);
  for_each_layout(sources, layouts, [&](SphereLayout& layout) {
    refine(layout, layout.mesh.vertex_slots(), observer);
    relax(layout, 10, observer);
  });
  advance(observer, {"correspondence", 3, kSteps});
  std::vector<SphericalMap> maps;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    stop_if_cancelled(observer);
    maps.push_back(map_of(sources[s], capped[s], layouts[s]));
  }
  verify(sources, maps, capped[0].apex >= 0);
  advance(observer, {"correspondence", kSteps, kSteps});
  return maps;
}

}  // namespace morphbake
