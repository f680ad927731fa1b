// bench [JSON [MARKDOWN]]: measures everything; prints a table, and writes it to files.

#include <fmt/core.h>
#include <malloc.h>

#include <climits>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

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

/// Keeps freed memory in the process. Else page faults, a third of the time of reading a source,
/// are timed with whatever happens to need new memory when glibc has given some back.
void keep_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, INT_MAX);
}

}  // namespace
}  // namespace morphbake::bench

int main(int argc, char** argv) {
  using namespace morphbake::bench;
  keep_memory();
  Figures figures;
  for (const int vertices : {10000, 100000, 500000}) {
    std::fprintf(stderr, "bench: %d vertices\n", vertices);
    bench_solvers(vertices, figures);
    bench_regions(vertices, figures);
  }
  bench_load(500000, figures);
  bench_export(100000, figures);
  bench_preview(100000, figures);
  std::fputs(to_markdown(figures).c_str(), stdout);
  if (argc > 1) std::ofstream(argv[1]) << to_json(figures);
  return 0;
}
