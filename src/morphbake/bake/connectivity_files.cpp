#include "morphbake/bake/connectivity_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "morphbake/bake/carried_colours.h"
#include "morphbake/bake/source_surfaces.h"
#include "morphbake/gltf/write_mesh.h"
#include "morphbake/mesh/normals.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

constexpr std::uint32_t kMapsVersion = 1;

using Edges = std::set<std::pair<int, int>>;

/// The vertices of the files.
struct FileVertices {
  std::vector<int> of_corner;   ///< 3 #F: corner 3 f + k -> vertex of the file
  std::vector<int> vertex;      ///< vertex of the file -> vertex of the triangulation
  std::vector<int> shading;     ///< 3 #F: corners of one number are shaded as one
  Float2s texture_coordinates;  ///< of each vertex, or no rows without a texture
};

std::pair<int, int> edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Joins the corners at a vertex over every edge that is not cut.
std::vector<int> corner_fans(const Triangles& triangles, const Edges& cut) {
  std::vector<int> parent(static_cast<std::size_t>(triangles.size()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int c) {
    while (parent[static_cast<std::size_t>(c)] != c) c = parent[static_cast<std::size_t>(c)];
    return c;
  };
  const auto join = [&](int a, int b) {
    const auto [low, high] = std::minmax({root(a), root(b)});
    parent[static_cast<std::size_t>(high)] = low;
  };
  std::map<std::pair<int, int>, std::pair<int, int>> corners_at;  // corners at the lower, upper end
  for (int f = 0; f < triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(f, k), b = triangles(f, (k + 1) % 3);
      if (cut.contains(edge_of(a, b))) continue;
      std::pair<int, int> corners{3 * f + k, 3 * f + (k + 1) % 3};
      if (a > b) std::swap(corners.first, corners.second);
      const auto [entry, is_new] = corners_at.try_emplace(edge_of(a, b), corners);
      if (is_new) continue;
      join(entry->second.first, corners.first);
      join(entry->second.second, corners.second);
    }
  }
  std::vector<int> fans;
  for (int c = 0; c < triangles.size(); ++c) fans.push_back(root(c));
  return fans;
}

Edges hard_edges(const SharedTriangulation& triangulation) {
  Edges hard;
  for (const Eigen::Vector2i& edge : triangulation.hard_edges) {
    hard.insert(edge_of(edge(0), edge(1)));
  }
  return hard;
}

/// Edges between triangles of different charts.
Edges seams(const Triangles& triangles, const std::vector<int>& chart) {
  std::map<std::pair<int, int>, int> chart_at;
  Edges found;
  for (int f = 0; f < triangles.rows(); ++f) {
    const int mine = chart[static_cast<std::size_t>(f)];
    for (int k = 0; k < 3; ++k) {
      const auto edge = edge_of(triangles(f, k), triangles(f, (k + 1) % 3));
      const auto [entry, is_new] = chart_at.try_emplace(edge, mine);
      if (!is_new && entry->second != mine) found.insert(edge);
    }
  }
  return found;
}

/// Gives each fan of corners a vertex of the file; the first one at a vertex has its number.
FileVertices vertices_of_fans(const Connectivity& k, const std::vector<int>& fans) {
  FileVertices vertices;
  vertices.vertex.resize(static_cast<std::size_t>(k.vertex_count));
  std::iota(vertices.vertex.begin(), vertices.vertex.end(), 0);
  std::vector<int> number(fans.size(), -1);  // of a fan, by its first corner
  std::vector<bool> taken(vertices.vertex.size(), false);
  for (std::size_t c = 0; c < fans.size(); ++c) {
    int& mine = number[static_cast<std::size_t>(fans[c])];
    if (mine < 0) {
      const int vertex = k.triangles.data()[c];
      mine = vertex;
      if (taken[static_cast<std::size_t>(vertex)]) {
        mine = static_cast<int>(vertices.vertex.size());
        vertices.vertex.push_back(vertex);
      }
      taken[static_cast<std::size_t>(vertex)] = true;
    }
    vertices.of_corner.push_back(mine);
  }
  return vertices;
}

FileVertices split_vertices(const SharedTriangulation& triangulation,
                            const std::optional<BakedTexture>& texture) {
  const Connectivity& k = triangulation.connectivity;
  Edges cut = hard_edges(triangulation);
  const std::vector<int> shading = corner_fans(k.triangles, cut);
  if (!texture) {
    FileVertices vertices = vertices_of_fans(k, shading);
    vertices.shading = vertices.of_corner;
    return vertices;
  }
  const Atlas& atlas = texture->atlas;
  cut.merge(seams(k.triangles, atlas.chart));
  FileVertices vertices = vertices_of_fans(k, corner_fans(k.triangles, cut));
  vertices.shading = shading;
  vertices.texture_coordinates.resize(static_cast<Eigen::Index>(vertices.vertex.size()), 2);
  for (std::size_t c = 0; c < vertices.of_corner.size(); ++c) {
    vertices.texture_coordinates.row(vertices.of_corner[c]) =
        atlas.places.row(atlas.of_corner[c]).cast<float>();
  }
  return vertices;
}

/// One a vertex of the file; those that only the texture splits are shaded as one.
Normals file_vertex_normals(const Positions& geometry, const Triangles& triangles,
                            const FileVertices& vertices) {
  const Normals groups = corner_group_normals(geometry, triangles, vertices.shading,
                                              static_cast<int>(vertices.shading.size()));
  Normals normals(static_cast<Eigen::Index>(vertices.vertex.size()), 3);
  for (std::size_t c = 0; c < vertices.of_corner.size(); ++c) {
    normals.row(vertices.of_corner[c]) = groups.row(vertices.shading[c]);
  }
  for (auto normal : normals.rowwise()) {
    if (normal.isZero(0)) normal << 0, 1, 0;  // no direction is right, but one must be written
  }
  return normals;
}

Eigen::Vector3d factor_of(const CarriedColours& look) {
  return look.material ? look.material->base_colour : Eigen::Vector3d(1, 1, 1);
}

/// Lets COLOR_0 tell sources apart that materials do, so that a morph may lead from one's colours
/// to the other's: a material's factor does not change in time.
void bring_under_one_factor(std::vector<CarriedColours>& looks, Eigen::Index vertices) {
  const auto differs = [&](const CarriedColours& look) {
    return factor_of(look) != factor_of(looks.front()) ||
           (look.colours.rows() > 0) != (looks.front().colours.rows() > 0);
  };
  if (std::none_of(looks.begin(), looks.end(), differs)) return;
  for (CarriedColours& look : looks) {
    if (look.colours.rows() == 0) look.colours = Float3s::Ones(vertices, 3);
    look.colours *= factor_of(look).cast<float>().asDiagonal();
    look.colours = look.colours.cwiseMax(0.0F).cwiseMin(1.0F).eval();
    if (look.material) look.material->base_colour.setOnes();
  }
}

std::string glb_of(const SourceMesh& source, CarriedColours look,
                   const SharedTriangulation& triangulation, std::size_t s,
                   const FileVertices& vertices) {
  const Positions& geometry = triangulation.geometries[s];
  const Triangles& triangles = triangulation.connectivity.triangles;
  PlainMesh mesh;
  mesh.name = source.name;
  mesh.copyright = copyright_of(source.file);
  mesh.material = std::move(look.material);
  mesh.triangles =
      Eigen::Map<const TriangleIndices>(vertices.of_corner.data(), triangles.rows(), 3);
  mesh.positions = geometry(vertices.vertex, Eigen::all).cast<float>();
  if (look.colours.rows() > 0) mesh.colours = look.colours(vertices.vertex, Eigen::all);
  mesh.normals = file_vertex_normals(geometry, triangles, vertices).cast<float>();
  mesh.texture_coordinates = vertices.texture_coordinates;
  return write_mesh_glb(mesh, fmt::format("morphbake {}", version()));
}

template <typename Number>
void append_number(std::string& bytes, Number number) {  // this machine is little-endian, as files
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void align(std::string& bytes) { bytes.resize((bytes.size() + 7) / 8 * 8, '\0'); }

/// Barycentric coordinates by the corners of the file, against which the surface may be wound.
Eigen::Vector3d barycentric_in_file(const SourceMesh& source, const SourceSurface& surface,
                                    const SurfacePoint& point, int triangle_in_file) {
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const int corner = source.triangles(triangle_in_file, k);
    for (int j = 0; j < 3; ++j) {
      const int on_surface = 3 * point.triangle + j;
      if (surface.render_of_corner[static_cast<std::size_t>(on_surface)] == corner) {
        weights(k) = point.barycentric(j);
      }
    }
  }
  return weights;
}

void append_map(const SourceMesh& source, const SourceSurface& surface,
                const std::vector<SurfacePoint>& points, const FileVertices& vertices,
                std::string& bytes) {
  append_number(bytes, static_cast<std::uint32_t>(source.name.size()));
  append_number(bytes, static_cast<std::uint32_t>(source.triangles.rows()));
  bytes += source.name;
  align(bytes);
  const std::vector<int> in_file = triangles_in_file(surface, source);
  const auto triangle_of = [&](int vertex) {
    return in_file[static_cast<std::size_t>(points[static_cast<std::size_t>(vertex)].triangle)];
  };
  for (const int vertex : vertices.vertex) {
    append_number(bytes, static_cast<std::uint32_t>(triangle_of(vertex)));
  }
  align(bytes);
  for (const int vertex : vertices.vertex) {
    const SurfacePoint& point = points[static_cast<std::size_t>(vertex)];
    const Eigen::Vector3d weights =
        barycentric_in_file(source, surface, point, triangle_of(vertex));
    for (int k = 0; k < 3; ++k) append_number(bytes, weights(k));
  }
}

}  // namespace

ConnectivityFiles write_connectivity_files(const std::vector<SourceMesh>& sources,
                                           const std::vector<SourceSurface>& surfaces,
                                           const SharedTriangulation& triangulation,
                                           const std::optional<BakedTexture>& texture,
                                           const Observer& observer) {
  const FileVertices vertices = split_vertices(triangulation, texture);
  ConnectivityFiles files;
  files.maps = "MORPHMAP";
  append_number(files.maps, kMapsVersion);
  append_number(files.maps, static_cast<std::uint32_t>(vertices.vertex.size()));
  append_number(files.maps, static_cast<std::uint32_t>(sources.size()));
  align(files.maps);
  std::vector<CarriedColours> looks;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    stop_if_cancelled(observer);
    if (texture) {
      looks.push_back({texture->material, {}});
      continue;
    }
    looks.push_back(carry_colours(sources[s], surfaces[s], triangulation.on_source[s], observer));
  }
  bring_under_one_factor(looks, triangulation.connectivity.vertex_count);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    files.glbs.push_back(glb_of(sources[s], std::move(looks[s]), triangulation, s, vertices));
    stop_if_cancelled(observer);
    append_map(sources[s], surfaces[s], triangulation.on_source[s], vertices, files.maps);
  }
  return files;
}

}  // namespace morphbake
