#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/bake/connectivity_report.h"
#include "morphbake/bake/options.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// What a remeshing did: --report writes it, schemas/remesh-report.schema.json describes it.
struct RemeshReport {
  std::string recipe;
  ConnectivityReport connectivity;
  std::vector<std::filesystem::path> files;
  std::vector<Problem> problems;  ///< warnings
};

std::string report_to_json(const RemeshReport& report);

/// Whether the sheet of pictures is made.
enum class SheetRequest { Make, None };

/// The files that remesh writes: <source>.glb each, <recipe>.maps.bin, <recipe>.connectivity.png.
std::vector<std::filesystem::path> remeshed_files(const Recipe& recipe,
                                                  const std::filesystem::path& folder,
                                                  SheetRequest sheet);

/// Writes the sources on their new connectivity. All files appear together, or none; but sources
/// of the mode Resample that are not connected alike leave <recipe>.mismatch.png.
///
/// @param recipe  of a mode other than Shared
/// @throws BakeError "recipe.overwrites-source" before any work; as remesh_sources; Cancelled
RemeshReport remesh(const Recipe& recipe, const BakeOptions& options,
                    const std::filesystem::path& folder, SheetRequest sheet,
                    const Observer& observer);

}  // namespace morphbake
