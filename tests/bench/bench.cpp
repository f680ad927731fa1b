// bench [NAME...] [> TABLE]: measures everything, or what is named: batch, solve, regions,
// eigenvectors, load, targets, export, preview, diff. With --json FILE first it writes the figures
// there as well.

#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/timing.h"

namespace morphbake::bench {
namespace {

std::string shown_value(const Figure& figure) {
  const double digits = figure.value >= 100 ? 0 : figure.value >= 10 ? 1 : 2;
  return fmt::format("{:.{}f}{}{}", figure.value, static_cast<int>(digits),
                     figure.unit.empty() ? "" : " ", figure.unit);
}

std::string to_markdown(const Figures& figures) {
  std::string text;
  std::string group;
  for (const Figure& figure : figures) {
    if (figure.group != group) {
      group = figure.group;
      text += fmt::format("\n| {} | | |\n|---|---:|---|\n", group);
    }
    text += fmt::format("| {} | {} | {} |\n", figure.name, shown_value(figure), figure.note);
  }
  return text;
}

std::string to_json(const Figures& figures) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Figure& figure : figures) {
    list.push_back({{"group", figure.group},
                    {"name", figure.name},
                    {"value", figure.value},
                    {"unit", figure.unit},
                    {"note", figure.note}});
  }
  return list.dump(1) + "\n";
}

std::function<void(Figures&)> at_each_size(void (*measure)(int, Figures&)) {
  return [measure](Figures& figures) {
    for (const int vertices : {10000, 100000, 500000}) measure(vertices, figures);
  };
}

/// Keeps freed memory in the process. Else page faults, which take longer than the reading of a
/// source does, are timed with whatever happens to need new memory when glibc has given some back.
void keep_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, INT_MAX);
}

}  // namespace
}  // namespace morphbake::bench

int main(int argc, char** argv) {
  using namespace morphbake::bench;
  keep_memory();
  std::vector<std::string> wanted(argv + 1, argv + argc);
  std::string json;
  if (wanted.size() >= 2 && wanted[0] == "--json") {
    json = wanted[1];
    wanted.erase(wanted.begin(), wanted.begin() + 2);
  }
  const std::vector<std::pair<std::string, std::function<void(Figures&)>>> all = {
      // First, since it forks, and must not have threads at work.
      {"batch", [](Figures& figures) { bench_batch(1000, figures); }},
      // Next, since what others free is kept, and would be counted as its memory.
      {"stream", [](Figures& figures) { bench_stream(1100000, 600, figures); }},
      {"solve", at_each_size(bench_solvers)},
      {"rotations", at_each_size(bench_rotations)},
      {"regions", at_each_size(bench_regions)},
      {"eigenvectors", [](Figures& figures) { bench_eigenvectors(50000, figures); }},
      {"load", [](Figures& figures) { bench_load(500000, figures); }},
      {"targets", [](Figures& figures) { bench_targets(100000, 240, figures); }},
      {"export", [](Figures& figures) { bench_export(100000, figures); }},
      {"preview", [](Figures& figures) { bench_preview(100000, figures); }},
      {"diff", [](Figures& figures) { bench_diff(100000, figures); }},
  };
  Figures figures;
  for (const auto& [name, measure] : all) {
    const bool is_wanted =
        wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
    if (!is_wanted) continue;
    std::fprintf(stderr, "bench: %s\n", name.c_str());
    measure(figures);
  }
  std::fputs(to_markdown(figures).c_str(), stdout);
  if (!json.empty()) std::ofstream(json) << to_json(figures);
  return figures.empty() ? 2 : 0;
}
