#include "morphbake/bake/compare.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/bake/previews.h"
#include "morphbake/files/distinct_names.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/preview/motion.h"
#include "morphbake/preview/turntable.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {
namespace {

constexpr int kIntervals = 48;   ///< between measured times
constexpr double kTorn = 1e-5;   ///< of the diagonal: files hold floats
constexpr int kSheetAcross = 8;  ///< pictures of single files in a row of the contact sheet

/// A file as it was read.
struct OpenMorph {
  std::string file;
  AnimatedMesh mesh;
  FollowedSurface surface;
  double diagonal = 0;  ///< at rest, scene units
};

[[noreturn]] void fail_at_node(const OpenMorph& morph, const char* code, std::string message) {
  throw BakeError(Problem{Severity::Error,
                          code,
                          {morph.file, fmt::format("/nodes/{}", morph.mesh.node), 0, 0},
                          std::move(message),
                          "compare files that move a morph; `morphbake inspect` lists targets and "
                          "animations, and --node chooses another mesh"});
}

OpenMorph open_morph(const std::filesystem::path& file, const ComparedPaths& paths) {
  const GltfFile document = open_gltf(file);
  OpenMorph morph;
  morph.file = file.string();
  morph.mesh = read_animated_mesh(document, {.node = paths.node}, paths.animation);
  if (morph.mesh.target_names.empty()) {
    fail_at_node(morph, "gltf.no-such-target", "the mesh of the node has no morph targets");
  }
  if (morph.mesh.weights.times.empty()) {
    fail_at_node(morph, "gltf.no-such-animation",
                 "no animation moves the weights of the node's mesh");
  }
  const SourceMesh source = read_source(morph.file, document, {.node = morph.mesh.node});
  morph.surface = follow_surface(source);
  morph.diagonal = bounding_diagonal(source.positions);
  return morph;
}

/// All files, or the problems of all.
std::vector<OpenMorph> open_morphs(const ComparedPaths& paths, const Observer& observer) {
  std::vector<OpenMorph> morphs;
  std::vector<Problem> problems;
  const auto total = static_cast<int>(paths.gltf_files.size());
  for (int i = 0; i < total; ++i) {
    advance(observer, {"load", i, total});
    try {
      morphs.push_back(open_morph(paths.gltf_files[static_cast<std::size_t>(i)], paths));
    } catch (const BakeError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return morphs;
}

/// Even steps over the clock of all animations; one time when none of them lasts.
std::vector<double> measured_times(const std::vector<OpenMorph>& morphs) {
  std::vector<PlayedSpan> spans;
  for (const OpenMorph& morph : morphs) spans.push_back(played_span(morph.mesh));
  const PlayedSpan span = common_span(spans);
  std::vector<double> times{span.begin};
  if (!(span.end > span.begin)) return times;
  for (int i = 1; i <= kIntervals; ++i) {
    times.push_back(span.begin + (span.end - span.begin) * i / kIntervals);
  }
  return times;
}

void warn_of_tears(const OpenMorph& morph, const MotionMeasures& measures,
                   const Observer& observer) {
  if (measures.largest_tear <= kTorn * morph.diagonal) return;
  report(observer,
         {Severity::Warning,
          "preview.torn",
          {morph.file, fmt::format("/nodes/{}", morph.mesh.node), 0, 0},
          fmt::format("vertices that are one point at rest are {:.3g} apart at {:.4g} s; the "
                      "surface is measured as if they stayed together",
                      measures.largest_tear, measures.tear_time),
          "give the vertices of a seam equal displacements in all targets"});
}

ComparedMorph measure(const OpenMorph& morph, const std::vector<double>& times, int threads,
                      const Observer& observer) {
  const FollowedSurface& surface = morph.surface;
  ComparedMorph compared;
  compared.file = morph.file;
  compared.node = morph.mesh.node;
  compared.begin = played_span(morph.mesh).begin;
  compared.end = played_span(morph.mesh).end;
  compared.vertices = static_cast<int>(surface.render_of.size());
  compared.triangles = static_cast<int>(surface.triangles.rows());
  compared.edges = static_cast<int>(surface.edges.ends.size());
  compared.is_closed = surface.edges.is_closed;
  try {
    compared.measures = measure_motion(morph.mesh, surface, times, threads, observer);
  } catch (const BakeError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) problem.location.file = morph.file;
    throw BakeError(std::move(problems));
  }
  warn_of_tears(morph, compared.measures, observer);
  return compared;
}

}  // namespace

Comparison compare_morphs(const ComparedPaths& paths, const PreviewRequest& request,
                          const BakeOptions& options, const Observer& observer) {
  std::vector<OpenMorph> morphs = open_morphs(paths, observer);
  const std::vector<std::string> labels = distinct_names(paths.gltf_files);
  const int count = static_cast<int>(morphs.size());
  Comparison comparison;
  comparison.times = measured_times(morphs);
  std::vector<TurntableSubject> subjects;
  for (std::size_t i = 0; i < morphs.size(); ++i) {
    advance(observer, {"measure", static_cast<int>(i), count});
    ComparedMorph& compared = comparison.morphs.emplace_back(
        measure(morphs[i], comparison.times, options.threads, observer));
    compared.label = labels[i];
    subjects.push_back({compared.file, compared.label, std::move(morphs[i].mesh)});
  }
  const std::vector<Image> rows =
      render_side_by_side(subjects, turntable_of(request, options), observer);
  PendingOutputs outputs;
  comparison.pictures = stage_loop(
      rows, paths.stem, request.formats,
      {.columns = std::max(1, kSheetAcross / count), .cell_width = rows.front().width / 2},
      outputs);
  outputs.commit();
  return comparison;
}

}  // namespace morphbake
