// Distances over a surface and floods, each beside the plainest way to the same: CGAL's heat method
// with the solver that it comes with, Boost's Dijkstra on CGAL's mesh, a queue over sets.

#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/helpers.h>

#include <array>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <cmath>
#include <queue>
#include <set>

#include "bench/timing.h"
#include "morphbake/transition/rings.h"
#include "morphbake/transition/surface_distance.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using VertexIndex = Surface::Vertex_index;
using PlainHeat =
    CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Surface,
                                                           CGAL::Heat_method_3::Intrinsic_Delaunay>;

Surface to_cgal(const Mesh& mesh) {
  Surface surface;
  for (const auto& p : mesh.positions.rowwise()) surface.add_vertex(Point(p(0), p(1), p(2)));
  std::vector<std::array<VertexIndex, 3>> faces;
  for (const auto& corners : mesh.triangles.rowwise()) {
    faces.push_back({VertexIndex(static_cast<unsigned>(corners(0))),
                     VertexIndex(static_cast<unsigned>(corners(1))),
                     VertexIndex(static_cast<unsigned>(corners(2)))});
  }
  CGAL::Euler::add_faces(faces, surface);
  return surface;
}

void plain_dijkstra(Surface& surface) {
  auto distance = surface.add_property_map<VertexIndex, double>("v:distance", 0).first;
  auto length = surface.add_property_map<Surface::Edge_index, double>("e:length", 0).first;
  for (const Surface::Edge_index edge : surface.edges()) {
    length[edge] = std::sqrt(CGAL::squared_distance(surface.point(surface.vertex(edge, 0)),
                                                    surface.point(surface.vertex(edge, 1))));
  }
  boost::dijkstra_shortest_paths(surface, VertexIndex(0),
                                 boost::distance_map(distance).weight_map(length).vertex_index_map(
                                     get(boost::vertex_index, surface)));
}

void plain_flood(const Mesh& mesh) {
  std::vector<std::set<int>> neighbours(static_cast<std::size_t>(mesh.positions.rows()));
  for (const auto& corners : mesh.triangles.rowwise()) {
    for (int k = 0; k < 3; ++k) {
      neighbours[static_cast<std::size_t>(corners(k))].insert(corners((k + 1) % 3));
      neighbours[static_cast<std::size_t>(corners((k + 1) % 3))].insert(corners(k));
    }
  }
  std::vector<int> hops(neighbours.size(), -1);
  std::queue<int> front({0});
  hops[0] = 0;
  while (!front.empty()) {
    const auto v = static_cast<std::size_t>(front.front());
    front.pop();
    for (const int neighbour : neighbours[v]) {
      int& count = hops[static_cast<std::size_t>(neighbour)];
      if (count >= 0) continue;
      count = hops[v] + 1;
      front.push(neighbour);
    }
  }
}

}  // namespace

void bench_regions(int vertices, Figures& figures) {
  const std::string group = "regions, " + shown_count(vertices) + " vertices";
  const int side = static_cast<int>(std::sqrt(vertices / 2.0));
  const Mesh mesh = test::torus(2 * side, side);
  const SurfacePoint centre{0, {0.3, 0.3, 0.4}};
  Surface surface = to_cgal(mesh);
  const auto add = [&](const char* name, const Pair& pair) {
    figures.push_back({group, std::string(name) + ", plain", pair.first * 1e3, "ms", ""});
    figures.push_back({group, name, pair.second * 1e3, "ms", ""});
    figures.push_back({group, std::string(name) + ", ours / plain", pair.ratio, "x", "pairs"});
  };
  add("along edges",
      time_pair(
          3, [&] { plain_dijkstra(surface); }, [&] { edge_distances(mesh, {centre}); }));
  add("flood by hops", time_pair(
                           3, [&] { plain_flood(mesh); },
                           [&] { flood_order(hop_distances(mesh, {0}), mesh.positions, 0); }));

  // Set up once, since CGAL's takes more than a minute.
  std::unique_ptr<PlainHeat> plain;
  std::unique_ptr<VertexDistances> ours;
  const double plain_seconds = seconds_of([&] {
    plain = std::make_unique<PlainHeat>(surface);
    plain->add_source(VertexIndex(0));
  });
  const double our_seconds = seconds_of([&] { ours = std::make_unique<VertexDistances>(mesh); });
  figures.push_back({group, "geodesic, set-up, plain", plain_seconds * 1e3, "ms", "one run"});
  figures.push_back({group, "geodesic, set-up", our_seconds * 1e3, "ms", "one run"});
  figures.push_back(
      {group, "geodesic, set-up, ours / plain", our_seconds / plain_seconds, "x", "one run"});
  int next = 0;
  const auto plain_from = [&] {
    auto distance = surface.add_property_map<VertexIndex, double>("v:heat", 0).first;
    plain->clear_sources();
    plain->add_source(VertexIndex(static_cast<unsigned>(++next)));
    plain->estimate_geodesic_distances(distance);
  };
  add("geodesic, each", time_pair(3, plain_from, [&] { ours->from(++next); }));
}

}  // namespace morphbake::bench
