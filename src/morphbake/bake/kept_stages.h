#pragma once

#include <optional>
#include <string>
#include <vector>

#include "morphbake/bake/bake.h"
#include "morphbake/bake/outputs.h"
#include "morphbake/cache/stage_cache.h"
#include "morphbake/solve/solve_fields.h"
#include "morphbake/transition/region_fields.h"

namespace morphbake {

// What stages give, as entries of the cache and back. Reading gives none where an entry does not
// fit: it is whole, as its hash says, but not what this stage writes.

/// New connectivity: the sources' files on it, and what was measured.
struct KeptConnectivity {
  std::vector<std::string> glbs;  ///< one a source
  ConnectivityReport report;
};

CacheEntry entry_of(const KeptConnectivity& connectivity);
std::optional<KeptConnectivity> connectivity_of(CacheEntry entry, std::size_t sources);

/// Whether a region takes longer to make than to read: what needs distances on the surface.
bool is_worth_keeping(const RegionOfInterest& region);

/// The fields of a recipe's regions that are worth keeping; none of the others.
struct KeptRegions {
  std::vector<std::optional<RegionField>> fields;  ///< one a region
};

KeptRegions kept_regions(const Recipe& recipe, const RegionFields& fields);

CacheEntry entry_of(const KeptRegions& regions);
std::optional<KeptRegions> regions_of(const CacheEntry& entry, const Recipe& recipe,
                                      Eigen::Index vertex_count);

/// Shapes of one connectivity.
struct KeptGeometries {
  std::vector<Positions> geometries;
};

CacheEntry entry_of(const KeptGeometries& kept);
std::optional<KeptGeometries> geometries_of(const CacheEntry& entry, std::size_t count,
                                            Eigen::Index vertex_count);

/// The shapes of a timeline, and how they were solved.
struct KeptShapes {
  SolvedShapes shapes;  ///< without records: the report has them
  SolveReport report;
};

CacheEntry entry_of(const KeptShapes& kept);
std::optional<KeptShapes> shapes_of(const CacheEntry& entry, std::size_t fields,
                                    Eigen::Index vertex_count);

/// @param output  whose report's file is not kept
CacheEntry entry_of(const BakedOutput& output);
std::optional<BakedOutput> output_of(CacheEntry entry, const std::filesystem::path& file);

/// What a report says of all stages before the outputs.
CacheEntry entry_of(const BakeReport& report);

/// Fills that in.
bool fill_in(const CacheEntry& entry, BakeReport& report);

/// Files that are named by what follows the name of an output: ".gif", ".sheet.png".
struct KeptFiles {
  std::vector<std::string> endings;
  std::vector<std::string> bytes;
};

CacheEntry entry_of(const KeptFiles& files);
std::optional<KeptFiles> files_of(CacheEntry entry);

}  // namespace morphbake
