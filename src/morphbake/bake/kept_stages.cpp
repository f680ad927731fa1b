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

CacheEntry entry_of(const RegionField& field) {
  if (const auto* flood = std::get_if<FloodField>(&field.form)) {
    return {Facts({{"softness", flood->softness}}).dump(), {bytes_of(flood->order)}};
  }
  return {"{}", {bytes_of(std::get<Eigen::VectorXd>(field.form))}};
}

std::optional<RegionField> region_of(const CacheEntry& entry, const RegionOfInterest& region,
                                     Eigen::Index vertex_count) {
  return reading<RegionField>(entry, [&](const Facts& facts) -> std::optional<RegionField> {
    RegionField field;
    field.falloff = region.falloff;
    Eigen::VectorXd values;
    if (entry.blobs.size() != 1 || !read_bytes(entry.blobs[0], vertex_count, values)) return {};
    field.floods = std::holds_alternative<FloodRegion>(region.shape);
    if (field.floods) {
      field.form = FloodField{std::move(values), facts.at("softness").get<double>()};
    } else {
      field.form = std::move(values);
    }
    return field;
  });
}

CacheEntry entry_of(const std::vector<Positions>& geometries) {
  CacheEntry entry;
  for (const Positions& positions : geometries) entry.blobs.push_back(bytes_of(positions));
  return entry;
}

std::optional<std::vector<Positions>> geometries_of(const CacheEntry& entry, std::size_t count,
                                                    Eigen::Index vertex_count) {
  if (entry.blobs.size() != count) return {};
  std::vector<Positions> geometries(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!read_bytes(entry.blobs[i], vertex_count, geometries[i])) return {};
  }
  return geometries;
}

CacheEntry entry_of(const KeptShapes& kept) {
  CacheEntry entry = entry_of(kept.shapes.displacements);
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
    if (!positions || kept.shapes.names.size() + 1 != fields) return {};
    kept.shapes.base = std::move(positions->front());
    positions->erase(positions->begin());
    kept.shapes.displacements = std::move(*positions);
    return kept;
  });
}

CacheEntry entry_of(const BakedOutput& output) {
  const OutputReport& report = output.report;
  const Facts facts = {{"kind", report.kind},
                       {"targets", report.targets},
                       {"weight_keys", report.weight_keys},
                       {"max_error", report.max_error},
                       {"worst_time", report.worst_time},
                       {"worst_vertex", report.worst_vertex},
                       {"normals", report.normals},
                       {"node", output.node}};
  return {facts.dump(), {output.glb}};
}

std::optional<BakedOutput> output_of(CacheEntry entry, const std::filesystem::path& file) {
  if (entry.blobs.size() != 1) return {};
  return reading<BakedOutput>(entry, [&](const Facts& facts) {
    BakedOutput output;
    output.glb = std::move(entry.blobs[0]);
    facts.at("node").get_to(output.node);
    OutputReport& report = output.report;
    report.file = file;
    report.bytes = output.glb.size();
    facts.at("kind").get_to(report.kind);
    facts.at("targets").get_to(report.targets);
    facts.at("weight_keys").get_to(report.weight_keys);
    facts.at("max_error").get_to(report.max_error);
    facts.at("worst_time").get_to(report.worst_time);
    facts.at("worst_vertex").get_to(report.worst_vertex);
    facts.at("normals").get_to(report.normals);
    return output;
  });
}

CacheEntry entry_of(const BakeReport& report) {
  return {Facts({{"vertices", report.vertices},
                 {"triangles", report.triangles},
                 {"components", report.components},
                 {"frames", report.frames},
                 {"connectivity", report.connectivity},
                 {"solve", report.solve}})
              .dump(),
          {}};
}

bool fill_in(const CacheEntry& entry, BakeReport& report) {
  const auto filled = reading<bool>(entry, [&](const Facts& facts) {
    facts.at("vertices").get_to(report.vertices);
    facts.at("triangles").get_to(report.triangles);
    facts.at("components").get_to(report.components);
    facts.at("frames").get_to(report.frames);
    facts.at("connectivity").get_to(report.connectivity);
    facts.at("solve").get_to(report.solve);
    return true;
  });
  return filled.has_value();
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
