#include "cli/comparison_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "morphbake/json/json.h"

namespace morphbake::cli {
namespace {

constexpr std::size_t kRowStep = 4;  // every fourth measured time has a row
constexpr std::size_t kNarrowestColumn = 20;

/// A measure as it is shown.
struct Measure {
  const char* json_name;
  const char* worst;                               ///< title of its worst values
  std::vector<double> MotionMeasures::*deviation;  ///< whose worst is told
  const char* over_time;                           ///< title of its table
  std::vector<double> MotionMeasures::*shown;      ///< what its table has
  bool is_share;                                   ///< deviation in % rather than in degrees
  bool is_relative;                                ///< table in % of the first frame
};

const std::array<Measure, 4> kMeasures = {{
    {"volume", "volume, off the mix", &MotionMeasures::volume_change,
     "volume, % of the first frame", &MotionMeasures::volume, true, true},
    {"area", "area, off the mix", &MotionMeasures::area_change, "area, % of the first frame",
     &MotionMeasures::area, true, true},
    {"edge_length_change", "edge lengths, rms", &MotionMeasures::edge_length_change,
     "edge lengths, rms off the mix in %", &MotionMeasures::edge_length_change, true, false},
    {"dihedral_angle_change", "dihedral angles, rms", &MotionMeasures::bend_change,
     "dihedral angles, rms off the mix in degrees", &MotionMeasures::bend_change, false, false},
}};

std::string percent(double share, bool is_signed) {
  return is_signed ? fmt::format("{:+.2f}", 100 * share) : fmt::format("{:.2f}", 100 * share);
}

/// Columns of one width, the first one on the left.
class Table {
 public:
  Table(const Comparison& comparison, std::size_t first_width) : first_width_(first_width) {
    for (const ComparedMorph& morph : comparison.morphs) {
      std::size_t letters = 0;
      for (const char byte : morph.label) letters += (byte & 0xC0) != 0x80 ? 1U : 0U;
      widths_.push_back(std::max(kNarrowestColumn, letters + 2));
    }
  }

  /// @param cell  text of a file's column
  template <class Cell>
  std::string row(const std::string& first, const Comparison& comparison, const Cell& cell) const {
    std::string line = fmt::format("{:<{}}", first, first_width_);
    for (std::size_t i = 0; i < widths_.size(); ++i) {
      line += fmt::format("{:>{}}", cell(comparison.morphs[i]), widths_[i]);
    }
    return line;
  }

  std::string head(const std::string& first, const Comparison& comparison) const {
    return row(first, comparison, [](const ComparedMorph& morph) { return morph.label; });
  }

 private:
  std::size_t first_width_;
  std::vector<std::size_t> widths_;
};

/// "open" for the volume of an open surface, "none" for what there is not.
std::string worst_text(const Measure& measure, const ComparedMorph& morph,
                       const std::vector<double>& times) {
  const std::vector<double>& values = morph.measures.*measure.deviation;
  if (values.empty()) return "open";
  const int at = furthest_from_zero(values);
  if (at < 0) return "none";
  const auto i = static_cast<std::size_t>(at);
  const std::string value = measure.is_share ? percent(values[i], measure.is_relative) + " %"
                                             : fmt::format("{:.2f} deg", values[i]);
  return fmt::format("{} at {:.2f} s", value, times[i]);
}

std::string value_text(const Measure& measure, const ComparedMorph& morph, std::size_t i) {
  const std::vector<double>& values = morph.measures.*measure.shown;
  if (values.empty()) return "open";
  if (std::isnan(values[i])) return "none";
  if (!measure.is_relative) {
    return measure.is_share ? percent(values[i], false) : fmt::format("{:.2f}", values[i]);
  }
  return values[0] != 0 ? percent(values[i] / values[0], false) : "none";
}

void add_files(const Comparison& comparison, std::vector<std::string>& lines) {
  const Table table(comparison, 24);
  const auto add = [&](const char* name, const auto& cell) {
    lines.push_back(table.row(name, comparison, cell));
  };
  using Morph = const ComparedMorph&;
  lines.push_back(table.head("first frames", comparison));
  add("  vertices", [](Morph morph) { return fmt::format("{}", morph.vertices); });
  add("  triangles", [](Morph morph) { return fmt::format("{}", morph.triangles); });
  add("  seconds", [](Morph morph) { return fmt::format("{:.4g}", morph.end - morph.begin); });
  add("  volume", [](Morph morph) {
    return morph.is_closed ? fmt::format("{:.4g}", morph.measures.volume[0]) : "open";
  });
  add("  area", [](Morph morph) { return fmt::format("{:.4g}", morph.measures.area[0]); });
}

void add_worst(const Comparison& comparison, std::vector<std::string>& lines) {
  const Table table(comparison, 24);
  lines.push_back("");
  lines.push_back(table.head("worst", comparison));
  for (const Measure& measure : kMeasures) {
    lines.push_back(table.row(
        fmt::format("  {}", measure.worst), comparison,
        [&](const ComparedMorph& morph) { return worst_text(measure, morph, comparison.times); }));
  }
}

void add_over_time(const Measure& measure, const Comparison& comparison,
                   std::vector<std::string>& lines) {
  const Table table(comparison, 10);
  lines.push_back("");
  lines.push_back(measure.over_time);
  lines.push_back(table.head("", comparison));
  for (std::size_t i = 0; i < comparison.times.size(); i += kRowStep) {
    lines.push_back(
        table.row(fmt::format("{:>8.2f} s", comparison.times[i]), comparison,
                  [&](const ComparedMorph& morph) { return value_text(measure, morph, i); }));
  }
}

Json worst_json(const Measure& measure, const ComparedMorph& morph,
                const std::vector<double>& times) {
  const std::vector<double>& deviations = morph.measures.*measure.deviation;
  const int at = furthest_from_zero(deviations);
  if (at < 0) return nullptr;
  const auto i = static_cast<std::size_t>(at);
  Json json;
  json["deviation"] = deviations[i];
  json["time"] = times[i];
  return json;
}

Json numbers(const std::vector<double>& values) {
  return values.empty() ? Json(nullptr) : Json(values);
}

Json morph_json(const ComparedMorph& morph, const std::vector<double>& times) {
  const MotionMeasures& measures = morph.measures;
  Json json;
  json["file"] = morph.file;
  json["label"] = morph.label;
  json["node"] = morph.node;
  json["begin"] = morph.begin;
  json["end"] = morph.end;
  json["vertices"] = morph.vertices;
  json["triangles"] = morph.triangles;
  json["edges"] = morph.edges;
  json["closed"] = morph.is_closed;
  json["volume"] = numbers(measures.volume);
  json["volume_change"] = numbers(measures.volume_change);
  json["area"] = numbers(measures.area);
  json["area_change"] = numbers(measures.area_change);
  json["edge_length_change"] = numbers(measures.edge_length_change);
  json["dihedral_angle_change"] = numbers(measures.bend_change);
  for (const Measure& measure : kMeasures) {
    json["worst"][measure.json_name] = worst_json(measure, morph, times);
  }
  json["largest_tear"] = measures.largest_tear;
  return json;
}

}  // namespace

std::vector<std::string> comparison_lines(const Comparison& comparison) {
  std::vector<std::string> lines;
  add_files(comparison, lines);
  add_worst(comparison, lines);
  for (const Measure& measure : kMeasures) add_over_time(measure, comparison, lines);
  return lines;
}

std::string comparison_json(const Comparison& comparison) {
  Json json;
  json["times"] = comparison.times;
  json["files"] = Json::array();
  for (const ComparedMorph& morph : comparison.morphs) {
    json["files"].push_back(morph_json(morph, comparison.times));
  }
  json["pictures"] = Json::array();
  for (const std::filesystem::path& picture : comparison.pictures) {
    json["pictures"].push_back(picture.string());
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace morphbake::cli
