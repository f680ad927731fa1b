#include "morphbake/recipe/reading.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/json/nearest.h"

namespace morphbake {
namespace {

constexpr std::size_t name_bytes = 63;
constexpr std::size_t hinted_problems = 100;
constexpr std::size_t listed_cycles = 100;

struct CycleSearch {
  enum class Mark { New, OnPath, Done };

  const std::vector<std::vector<int>>& edges;
  std::vector<Mark> marks;
  std::vector<int> path;
  std::vector<std::vector<int>> cycles;

  void visit(int node) {
    marks[node] = Mark::OnPath;
    path.push_back(node);
    for (const int next : edges[node]) {
      if (next < 0 || next >= static_cast<int>(edges.size())) continue;
      if (marks[next] == Mark::New) visit(next);
      if (marks[next] == Mark::OnPath && cycles.size() < listed_cycles) {
        cycles.emplace_back(std::find(path.begin(), path.end(), next), path.end());
      }
    }
    path.pop_back();
    marks[node] = Mark::Done;
  }
};

}  // namespace

void complain(Reading& reading, std::string code, const std::string& pointer, std::string message,
              std::string hint) {
  reading.problems.push_back({Severity::Error, std::move(code),
                              location_in(reading.recipe, pointer), std::move(message),
                              std::move(hint)});
}

bool wants_hints(const Reading& reading) { return reading.problems.size() < hinted_problems; }

void complain_unknown(Reading& reading, const std::vector<std::string>& names,
                      std::string_view kind, const Json& name, const std::string& pointer) {
  const bool hinted = wants_hints(reading);
  const Json& sources = reading.document.at("sources");
  const auto written = sources.find(name.get<std::string>());
  const bool is_derived =
      written != sources.end() && written->is_object() && !written->contains("file");
  if (kind == "source" && is_derived) {
    complain(reading, "recipe.unknown-name", pointer,
             fmt::format("{} is made from another source: it has no file and no points of its own",
                         shown(name)),
             name_hint("", names, "sources with a file"));
    return;
  }
  complain(reading, "recipe.unknown-name", pointer,
           fmt::format("there is no {} {}", kind, shown(name)),
           hinted ? name_hint(name.get<std::string>(), names, fmt::format("{}s", kind)) : "");
}

void check_one_of(Reading& reading, const Json& json, const std::vector<const char*>& fields,
                  const char* what, const std::string& pointer) {
  std::vector<std::string> given;
  std::string all;
  for (const char* field : fields) {
    if (json.contains(field)) given.emplace_back(field);
    all += (all.empty() ? "" : ", ") + std::string(field);
  }
  if (given.size() > 1) {
    complain(reading, "recipe.conflicting-fields", pointer,
             fmt::format("\"{}\" and \"{}\" exclude each other", given[0], given[1]),
             fmt::format("give one {}", what));
  } else if (given.empty()) {
    complain(reading, "recipe.missing-field", pointer, fmt::format("there is no {}", what),
             fmt::format("give one of {}", all));
  }
}

void check_name_length(Reading& reading, const std::string& name, const std::string& pointer) {
  if (name.size() <= name_bytes) return;
  complain(
      reading, "recipe.bad-value", pointer,
      fmt::format("the name {} has {} bytes; at most {} are allowed", shown(Json(name)),
                  name.size(), name_bytes),
      "names become names of glTF morph targets, which importers cut; letters beyond ASCII take "
      "2 to 4 bytes");
}

int read_region_field(Reading& reading, const Json& parent, const std::string& pointer) {
  const auto region = parent.find("region");
  if (region == parent.end()) return -1;
  return look_up(reading, reading.recipe.regions, "region", *region, pointer + "/region");
}

Easing ease_of(const Json& name) {
  if (name.is_array()) {
    Easing easing(Ease::Bezier);
    for (std::size_t k = 0; k < 4; ++k) easing.control[k] = name[k].get<double>();
    return easing;
  }
  if (name == "linear") return Ease::Linear;
  if (name == "step") return Ease::Step;
  if (name == "cubic") return Ease::Cubic;
  return Ease::Smoothstep;
}

std::vector<std::vector<int>> find_cycles(const std::vector<std::vector<int>>& edges) {
  CycleSearch search{edges, std::vector(edges.size(), CycleSearch::Mark::New), {}, {}};
  for (std::size_t node = 0; node < edges.size(); ++node) {
    if (search.marks[node] == CycleSearch::Mark::New) search.visit(static_cast<int>(node));
  }
  return search.cycles;
}

int whole_number(const Json& json) {
  return static_cast<int>(std::clamp(json.get<double>(), 0.0, 1e8));
}

int whole_number(const Json& owner, const char* field) {
  return owner.contains(field) ? whole_number(owner[field]) : 0;
}

NameOrIndex name_or_index(const Json& owner, const char* field) {
  if (!owner.contains(field)) return {};
  const Json& value = owner[field];
  if (value.is_string()) return value.get<std::string>();
  return whole_number(value);
}

}  // namespace morphbake
