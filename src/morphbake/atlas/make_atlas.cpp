#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "morphbake/atlas/atlas.h"
#include "morphbake/atlas/flatten_chart.h"
#include "morphbake/atlas/merge_charts.h"
#include "morphbake/atlas/pack_charts.h"

namespace morphbake {
namespace {

/// One a node of the forest: what could be laid flat.
std::vector<std::optional<FlatChart>> flatten_nodes(const Mesh& mesh, const ChartForest& forest,
                                                    const std::vector<int>& nodes,
                                                    const Observer& observer) {
  std::vector<std::optional<FlatChart>> charts(nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t i) {
    stop_if_cancelled(observer);
    charts[i] = flatten_chart(mesh, triangles_of(forest, nodes[i]));
  });
  return charts;
}

/// The largest disks of the forest that lie flat.
std::vector<FlatChart> flat_charts(const Mesh& mesh, const ChartForest& forest,
                                   const Observer& observer) {
  std::vector<FlatChart> charts;
  std::vector<int> nodes = forest.roots;
  while (!nodes.empty()) {
    std::vector<int> parts;
    auto flattened = flatten_nodes(mesh, forest, nodes, observer);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (flattened[i]) {
        charts.push_back(std::move(*flattened[i]));
        continue;
      }
      const auto node = static_cast<std::size_t>(nodes[i] - forest.triangle_count);
      std::copy(forest.merged[node].begin(), forest.merged[node].end(), std::back_inserter(parts));
    }
    nodes = std::move(parts);
  }
  std::sort(charts.begin(), charts.end(), [](const FlatChart& a, const FlatChart& b) {
    return a.triangles.front() < b.triangles.front();
  });
  return charts;
}

[[noreturn]] void fail_too_small(int size, std::size_t charts, int padding) {
  Problem problem;
  problem.code = "connectivity.texture-too-small";
  problem.message =
      fmt::format("{} charts with {} texels of padding find no room on {} x {} texels", charts,
                  padding, size, size);
  problem.hint = "give the texture a larger size or a smaller padding";
  throw BakeError(std::move(problem));
}

/// Share of the unit square that triangles cover.
double covered_share(const Atlas& atlas) {
  double area = 0;
  for (std::size_t c = 0; c < atlas.of_corner.size(); c += 3) {
    const auto place = [&](std::size_t k) { return atlas.places.row(atlas.of_corner[c + k]); };
    const Eigen::RowVector2d a = place(1) - place(0), b = place(2) - place(0);
    area += (a.y() * b.x() - a.x() * b.y()) / 2;  // y runs downwards
  }
  return area;
}

}  // namespace

Atlas make_atlas(const Mesh& mesh, const std::vector<Eigen::Vector2i>& hard_edges,
                 const AtlasOptions& options, const Observer& observer) {
  const ChartForest forest = merge_charts(mesh, hard_edges, observer);
  std::vector<FlatChart> charts = flat_charts(mesh, forest, observer);
  const double scale = pack_charts(charts, options.size, options.padding, observer);
  if (scale == 0) fail_too_small(options.size, charts.size(), options.padding);
  Atlas atlas;
  atlas.size = options.size;
  atlas.padding = options.padding;
  atlas.chart_count = static_cast<int>(charts.size());
  atlas.chart.resize(static_cast<std::size_t>(mesh.triangles.rows()));
  atlas.of_corner.resize(static_cast<std::size_t>(mesh.triangles.size()));
  Eigen::Index rows = 0;
  for (const FlatChart& chart : charts) rows += chart.places.rows();
  atlas.places.resize(rows, 2);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const FlatChart& chart = charts[i];
    atlas.places.middleRows(row, chart.places.rows()) = chart.places / options.size;
    for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
      const auto triangle = static_cast<std::size_t>(chart.triangles[t]);
      atlas.chart[triangle] = static_cast<int>(i);
      for (std::size_t k = 0; k < 3; ++k) {
        atlas.of_corner[3 * triangle + k] = static_cast<int>(row) + chart.of_corner[3 * t + k];
      }
    }
    row += chart.places.rows();
  }
  atlas.covered = covered_share(atlas);
  return atlas;
}

}  // namespace morphbake
