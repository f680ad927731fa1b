#include "morphbake/bake/kept_stages.h"

#include <cstring>
#include <utility>

#include "morphbake/bake/report_json.h"

namespace morphbake {
namespace {

using Facts = nlohmann::json;

/// A matrix as the bytes of its numbers.
template <typename Matrix>
std::string bytes_of(const Matrix& matrix) {
  const auto* begin = reinterpret_cast<const char*>(matrix.data());
  return {begin, static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar)};
}

/// @return  false where it has another size
template <typename Matrix>
bool read_bytes(const std::string& bytes, Eigen::Index rows, Matrix& matrix) {
  matrix.resize(rows, Matrix::ColsAtCompileTime);
  const std::size_t size =
      static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar);
  if (bytes.size() != size) return false;
  if (size > 0) std::memcpy(matrix.data(), bytes.data(), size);
  return true;
}

/// What `read` makes of the facts, or none where they are others than it looks for.
template <typename Result, typename Read>
std::optional<Result> reading(const CacheEntry& entry, const Read& read) {
  try {
    return read(Facts::parse(entry.facts));
  } catch (const Facts::exception&) {
    return std::nullopt;
  }
}

}  // namespace

CacheEntry entry_of(const KeptConnectivity& connectivity) {
  return {Facts(connectivity.report).dump(), connectivity.glbs};
}

std::optional<KeptConnectivity> connectivity_of(CacheEntry entry, std::size_t sources) {
  if (entry.blobs.size() != sources) return {};
  return reading<KeptConnectivity>(entry, [&](const Facts& facts) {
    return KeptConnectivity{std::move(entry.blobs), facts.get<ConnectivityReport>()};
  });
}

bool is_worth_keeping(const RegionOfInterest& region) {
  return std::holds_alternative<BallRegion>(region.shape) ||
         std::holds_alternative<RingsRegion>(region.shape) ||
         std::holds_alternative<ScatteredRegion>(region.shape) ||
         std::holds_alternative<FloodRegion>(region.shape);
}

KeptRegions kept_regions(const Recipe& recipe, const RegionFields& fields) {
  KeptRegions kept;
  for (std::size_t r = 0; r < fields.size(); ++r) {
    const bool keeps = is_worth_keeping(recipe.regions[r]);
    kept.fields.push_back(keeps ? std::optional(fields[r]) : std::nullopt);
  }
  return kept;
}

CacheEntry entry_of(const KeptRegions& regions) {
  Facts softness = Facts::array();
  CacheEntry entry;
  for (const std::optional<RegionField>& field : regions.fields) {
    if (!field) continue;
    const auto* flood = std::get_if<FloodField>(&field->form);
    softness.push_back(flood == nullptr ? 0 : flood->softness);
    entry.blobs.push_back(
        bytes_of(flood == nullptr ? std::get<Eigen::VectorXd>(field->form) : flood->order));
  }
  entry.facts = Facts({{"softness", softness}}).dump();
  return entry;
}

std::optional<KeptRegions> regions_of(const CacheEntry& entry, const Recipe& recipe,
                                      Eigen::Index vertex_count) {
  return reading<KeptRegions>(entry, [&](const Facts& facts) -> std::optional<KeptRegions> {
    KeptRegions kept;
    std::size_t next = 0;
    for (const RegionOfInterest& region : recipe.regions) {
      std::optional<RegionField>& field = kept.fields.emplace_back();
      if (!is_worth_keeping(region)) continue;
      Eigen::VectorXd values;
      if (next >= entry.blobs.size() || !read_bytes(entry.blobs[next], vertex_count, values)) {
        return {};
      }
      field.emplace();
      field->falloff = region.falloff;
      field->floods = std::holds_alternative<FloodRegion>(region.shape);
      const auto softness = facts.at("softness").at(next++).get<double>();
      if (field->floods) {
        field->form = FloodField{std::move(values), softness};
      } else {
        field->form = std::move(values);
      }
    }
    if (next != entry.blobs.size()) return {};
    return kept;
  });
}

CacheEntry entry_of(const KeptGeometries& kept) {
  CacheEntry entry;
  for (const Positions& positions : kept.geometries) entry.blobs.push_back(bytes_of(positions));
  return entry;
}

std::optional<KeptGeometries> geometries_of(const CacheEntry& entry, std::size_t count,
                                            Eigen::Index vertex_count) {
  if (entry.blobs.size() != count) return {};
  KeptGeometries kept{std::vector<Positions>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    if (!read_bytes(entry.blobs[i], vertex_count, kept.geometries[i])) return {};
  }
  return kept;
}

CacheEntry entry_of(const KeptShapes& kept) {
  CacheEntry entry = entry_of(KeptGeometries{kept.shapes.displacements});
  entry.blobs.insert(entry.blobs.begin(), bytes_of(kept.shapes.base));
  entry.facts = Facts({{"names", kept.shapes.names}, {"report", kept.report}}).dump();
  return entry;
}

std::optional<KeptShapes> shapes_of(const CacheEntry& entry, std::size_t fields,
                                    Eigen::Index vertex_count) {
  return reading<KeptShapes>(entry, [&](const Facts& facts) -> std::optional<KeptShapes> {
    auto positions = geometries_of(entry, fields, vertex_count);
    KeptShapes kept;
    facts.at("names").get_to(kept.shapes.names);
    facts.at("report").get_to(kept.report);
    if (!positions || fields == 0 || kept.shapes.names.size() + 1 != fields) return {};
    std::vector<Positions>& shapes = positions->geometries;
    kept.shapes.base = std::move(shapes.front());
    shapes.erase(shapes.begin());
    kept.shapes.displacements = std::move(shapes);
    return kept;
  });
}

CacheEntry entry_of(const BakedOutput& output) {
  return {Facts({{"report", output.report}, {"node", output.node}}).dump(), {output.glb}};
}

std::optional<BakedOutput> output_of(CacheEntry entry, const std::filesystem::path& file) {
  if (entry.blobs.size() != 1) return {};
  return reading<BakedOutput>(entry, [&](const Facts& facts) {
    BakedOutput output;
    facts.at("report").get_to(output.report);
    facts.at("node").get_to(output.node);
    output.glb = std::move(entry.blobs[0]);
    output.report.file = file;
    output.report.bytes = output.glb.size();
    return output;
  });
}

CacheEntry entry_of(const BakeReport& report) { return {Facts(report).dump(), {}}; }

bool fill_in(const CacheEntry& entry, BakeReport& report) {
  return reading<bool>(entry,
                       [&](const Facts& facts) {
                         facts.get_to(report);
                         return true;
                       })
      .has_value();
}

CacheEntry entry_of(const KeptFiles& files) {
  return {Facts({{"endings", files.endings}}).dump(), files.bytes};
}

std::optional<KeptFiles> files_of(CacheEntry entry) {
  return reading<KeptFiles>(entry, [&](const Facts& facts) -> std::optional<KeptFiles> {
    KeptFiles files{facts.at("endings").get<std::vector<std::string>>(), std::move(entry.blobs)};
    if (files.endings.size() != files.bytes.size()) return {};
    return files;
  });
}

}  // namespace morphbake
