#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/bake/connectivity_report.h"
#include "morphbake/bake/options.h"
#include "morphbake/cache/stage_cache.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/solve/solve_fields.h"

namespace morphbake {

/// How far written normals are from those of the exact surface.
struct NormalReport {
  double maximum = 0;        ///< degrees
  double percentile_99 = 0;  ///< degrees, of all vertices at all frames and half-way between
  double time = 0;           ///< seconds, of the largest
  int vertex = 0;            ///< of the file, counted over its primitives; of the largest
};

struct OutputReport {
  std::filesystem::path file;
  std::size_t bytes = 0;
  std::string kind;  ///< of targets: "tracks", "keyframes", "basis", "frames", or "still"
  std::vector<std::string> targets;
  int weight_keys = 0;
  double max_error = 0;   ///< of written positions at frames and middles, share of the diagonal
  double worst_time = 0;  ///< seconds, of that
  int worst_vertex = 0;   ///< of the file, counted over its primitives; of that
  NormalReport normals;
  std::vector<std::filesystem::path> previews;
};

/// How the timeline's systems were solved.
struct SolveReport {
  std::string representation;  ///< "laplacian", "rotation"
  std::string representation_reason;
  std::string solver;  ///< "direct", "warm", "pcg", "gauss-seidel", "jacobi"
  std::string reason;
  int unknowns = 0;
  int held = 0;  ///< vertices
  std::size_t factor_bytes = 0;
  std::vector<SolveRecord> solves;  ///< errors as fractions of the diagonal
};

/// What a bake did: --report writes it, schemas/report.schema.json describes it.
struct BakeReport {
  std::string recipe;
  int vertices = 0;  ///< of the shared connectivity
  int triangles = 0;
  int components = 0;
  int frames = 0;
  ConnectivityReport connectivity;
  SolveReport solve;
  std::vector<StageReport> stages;  ///< that ran
  std::vector<std::string> cached;  ///< names of what was taken from the cache
  std::vector<OutputReport> outputs;
  std::vector<Problem> problems;  ///< warnings
};

std::string report_to_json(const BakeReport& report);

/// Bakes a recipe: one call a stage. All output files appear together at the end, or none; but
/// sources that are not connected alike leave a picture of it, <first output>.mismatch.png.
///
/// What the cache has is not made again, and the bytes are the same with it and without.
/// @param cache  where results are looked for and kept; StageCache() for none
/// @throws BakeError, Cancelled
BakeReport bake(const Recipe& recipe, const BakeOptions& options, const StageCache& cache,
                const Observer& observer);

/// Checks names, sources, landmarks and topology without solving or writing.
///
/// @throws BakeError with all problems found
void validate(const Recipe& recipe, const BakeOptions& options, const Observer& observer);

}  // namespace morphbake
