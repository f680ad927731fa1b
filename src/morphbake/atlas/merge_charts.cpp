#include "morphbake/atlas/merge_charts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

namespace morphbake {
namespace {

/// A cap with half-angle t has the bend 1 - ((1 + cos t) / 2)^2: this is one of 60 degrees.
constexpr double kMostBend = 0.45;
constexpr double kRoundness = 0.1;  // of a border's length squared by area, against the bend
constexpr double kHardness = 1.0;   // of the hard share of a common border, against the bend
constexpr int kStride = 1024;       // merges between two looks whether to stop

/// An edge of the mesh with the triangles on its sides, -1 beyond a border.
struct ChartEdge {
  std::array<int, 2> vertices{};
  std::array<int, 2> triangles{-1, -1};
  double length = 0;
  bool is_hard = false;
};

std::vector<ChartEdge> edges_of(const Mesh& mesh, const std::vector<Eigen::Vector2i>& hard_edges) {
  std::set<std::pair<int, int>> hard;
  for (const Eigen::Vector2i& edge : hard_edges) hard.emplace(edge(0), edge(1));
  std::vector<std::tuple<int, int, int>> sides;  // low, high, triangle
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({mesh.triangles(f, k), mesh.triangles(f, (k + 1) % 3)});
      sides.emplace_back(low, high, f);
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<ChartEdge> edges;
  for (const auto& [low, high, triangle] : sides) {
    if (!edges.empty() && edges.back().vertices == std::array{low, high}) {
      edges.back().triangles[1] = triangle;
      continue;
    }
    ChartEdge edge;
    edge.vertices = {low, high};
    edge.triangles[0] = triangle;
    edge.length = (mesh.positions.row(low) - mesh.positions.row(high)).norm();
    edge.is_hard = hard.contains({low, high});
    edges.push_back(edge);
  }
  return edges;
}

/// A disk of triangles.
struct Disk {
  double area = 0;
  Eigen::Vector3d normal_area = Eigen::Vector3d::Zero();  ///< sum of normals times areas
  double perimeter = 0;
  std::vector<int> border;  ///< its edges
};

/// What two neighbours have in common.
struct Contact {
  double length = 0;
  double hard_length = 0;
};

/// A merge that could be; the cheapest, then the oldest is made first.
using Offer = std::tuple<double, int, int>;

struct Merging {
  std::vector<ChartEdge> edges;
  std::vector<Disk> disks;  ///< one a node
  std::vector<int> owner;   ///< node -> the node it went into, itself when it is the last
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers;
};

int last_owner(Merging& merging, int node) {
  std::vector<int>& owner = merging.owner;
  const auto at = [&](int n) -> int& { return owner[static_cast<std::size_t>(n)]; };
  while (at(node) != node) {
    at(node) = at(at(node));
    node = at(node);
  }
  return node;
}

Disk& disk_of(Merging& merging, int node) { return merging.disks[static_cast<std::size_t>(node)]; }

/// The node on the other side of a border edge of `node`, -1 beyond the mesh's border.
int neighbour_across(Merging& merging, int edge, int node) {
  for (const int triangle : merging.edges[static_cast<std::size_t>(edge)].triangles) {
    if (triangle < 0) return -1;
    const int owner = last_owner(merging, triangle);
    if (owner != node) return owner;
  }
  return node;
}

void make_offer(Merging& merging, int a, int b, const Contact& contact) {
  const Disk& first = disk_of(merging, a);
  const Disk& second = disk_of(merging, b);
  const double area = first.area + second.area;
  const double perimeter = first.perimeter + second.perimeter - 2 * contact.length;
  double bend = 0, roundness = 1;
  if (area > 0) {
    bend = 1 - (first.normal_area + second.normal_area).squaredNorm() / (area * area);
    roundness = perimeter * perimeter / (4 * std::numbers::pi * area);
  }
  if (bend > kMostBend) return;
  const double hard = contact.length > 0 ? contact.hard_length / contact.length : 0;
  merging.offers.emplace(bend + kRoundness * roundness + kHardness * hard, std::min(a, b),
                         std::max(a, b));
}

/// Offers of a node with all its neighbours.
void make_offers(Merging& merging, int node) {
  std::vector<std::pair<int, int>> across;  // neighbour, edge
  for (const int edge : disk_of(merging, node).border) {
    const int neighbour = neighbour_across(merging, edge, node);
    if (neighbour >= 0) across.emplace_back(neighbour, edge);
  }
  std::sort(across.begin(), across.end());
  for (std::size_t i = 0; i < across.size();) {
    Contact contact;
    const int neighbour = across[i].first;
    for (; i < across.size() && across[i].first == neighbour; ++i) {
      const ChartEdge& edge = merging.edges[static_cast<std::size_t>(across[i].second)];
      contact.length += edge.length;
      if (edge.is_hard) contact.hard_length += edge.length;
    }
    make_offer(merging, node, neighbour, contact);
  }
}

std::vector<int> border_vertices(const Merging& merging, const Disk& disk) {
  std::vector<int> vertices;
  for (const int edge : disk.border) {
    const auto& ends = merging.edges[static_cast<std::size_t>(edge)].vertices;
    vertices.insert(vertices.end(), ends.begin(), ends.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

/// Whether two disks make a disk: what they share, vertices less edges, has the Euler
/// characteristic of a path. A touch at one more vertex, or a closed ring, has not.
bool makes_disk(Merging& merging, int a, int b) {
  const std::vector<int> first = border_vertices(merging, disk_of(merging, a));
  const std::vector<int> second = border_vertices(merging, disk_of(merging, b));
  std::vector<int> shared;
  std::set_intersection(first.begin(), first.end(), second.begin(), second.end(),
                        std::back_inserter(shared));
  std::ptrdiff_t edges = 0;
  for (const int edge : disk_of(merging, a).border) {
    if (neighbour_across(merging, edge, a) == b) ++edges;
  }
  return static_cast<std::ptrdiff_t>(shared.size()) - edges == 1;
}

/// The two as one new node.
void merge(Merging& merging, int a, int b) {
  const int node = static_cast<int>(merging.disks.size());
  Disk disk;
  for (const int part : {a, b}) {
    const Disk& from = disk_of(merging, part);
    disk.area += from.area;
    disk.normal_area += from.normal_area;
    for (const int edge : from.border) {
      const int neighbour = neighbour_across(merging, edge, part);
      if (neighbour == a || neighbour == b) continue;
      disk.border.push_back(edge);
      disk.perimeter += merging.edges[static_cast<std::size_t>(edge)].length;
    }
  }
  disk_of(merging, a) = {};  // nobody asks again
  disk_of(merging, b) = {};
  merging.disks.push_back(std::move(disk));
  merging.owner.push_back(node);
  merging.owner[static_cast<std::size_t>(a)] = node;
  merging.owner[static_cast<std::size_t>(b)] = node;
}

Merging start_merging(const Mesh& mesh, const std::vector<Eigen::Vector2i>& hard_edges) {
  Merging merging;
  merging.edges = edges_of(mesh, hard_edges);
  merging.disks.resize(static_cast<std::size_t>(mesh.triangles.rows()));
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    const auto corner = [&](int k) {
      return Eigen::Vector3d(mesh.positions.row(mesh.triangles(f, k)).transpose());
    };
    Disk& disk = disk_of(merging, f);
    disk.normal_area = (corner(1) - corner(0)).cross(corner(2) - corner(0)) / 2;
    disk.area = disk.normal_area.norm();
    merging.owner.push_back(f);
  }
  for (std::size_t e = 0; e < merging.edges.size(); ++e) {
    for (const int triangle : merging.edges[e].triangles) {
      if (triangle < 0) continue;
      disk_of(merging, triangle).border.push_back(static_cast<int>(e));
      disk_of(merging, triangle).perimeter += merging.edges[e].length;
    }
  }
  for (const ChartEdge& edge : merging.edges) {
    const auto [first, second] = edge.triangles;
    const Contact contact{edge.length, edge.is_hard ? edge.length : 0};
    if (second >= 0) make_offer(merging, first, second, contact);
  }
  return merging;
}

}  // namespace

ChartForest merge_charts(const Mesh& mesh, const std::vector<Eigen::Vector2i>& hard_edges,
                         const Observer& observer) {
  ChartForest forest;
  forest.triangle_count = static_cast<int>(mesh.triangles.rows());
  Merging merging = start_merging(mesh, hard_edges);
  while (!merging.offers.empty()) {
    const auto [cost, a, b] = merging.offers.top();
    merging.offers.pop();
    const auto is_last = [&](int n) { return merging.owner[static_cast<std::size_t>(n)] == n; };
    if (!is_last(a) || !is_last(b) || !makes_disk(merging, a, b)) continue;
    merge(merging, a, b);
    forest.merged.push_back({a, b});
    make_offers(merging, static_cast<int>(merging.disks.size()) - 1);
    if (forest.merged.size() % kStride == 0) stop_if_cancelled(observer);
  }
  for (std::size_t n = 0; n < merging.owner.size(); ++n) {
    if (merging.owner[n] == static_cast<int>(n)) forest.roots.push_back(static_cast<int>(n));
  }
  return forest;
}

std::vector<int> triangles_of(const ChartForest& forest, int node) {
  std::vector<int> triangles, nodes{node};
  while (!nodes.empty()) {
    const int next = nodes.back();
    nodes.pop_back();
    if (next < forest.triangle_count) {
      triangles.push_back(next);
      continue;
    }
    const auto& parts = forest.merged[static_cast<std::size_t>(next - forest.triangle_count)];
    nodes.insert(nodes.end(), parts.begin(), parts.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace morphbake
