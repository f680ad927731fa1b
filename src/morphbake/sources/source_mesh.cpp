#include "morphbake/sources/source_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <span>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

void to_scene(const Float3s& positions, const Eigen::Matrix4d& transform,
              Eigen::Ref<Positions> scene) {
  const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
  const Eigen::RowVector3d translation = transform.topRightCorner<3, 1>().transpose();
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    scene.row(v) = positions.row(v).cast<double>() * linear.transpose() + translation;
  }
}

/// Squares and cubes of lengths must neither overflow nor vanish.
void check_size(const SourceMesh& mesh) {
  constexpr double kLargest = 1e60, kSmallest = 1e-60;
  const double reach = mesh.positions.size() == 0 ? 1 : mesh.positions.cwiseAbs().maxCoeff();
  if (reach < kLargest && (reach == 0 || reach > kSmallest)) return;
  throw BakeError(Problem{Severity::Error,
                          "gltf.extreme-size",
                          {file_of(mesh.file), fmt::format("/nodes/{}", mesh.geometry.node), 0, 0},
                          fmt::format("coordinates reach {:.3g} in the scene; {:.0e} to {:.0e} can "
                                      "be computed with",
                                      reach, kSmallest, kLargest),
                          "check the node's scale and matrix"});
}

/// Files hold floats, which lose their digits towards 1e-38: a morph of a tiny mesh would be
/// coarse.
void check_digits(const SourceMesh& mesh) {
  constexpr float kSmallest = 1e-30F;
  float reach = 0;
  for (const PrimitiveGeometry& primitive : mesh.geometry.primitives) {
    if (primitive.positions.size() == 0) continue;
    reach = std::max(reach, primitive.positions.cwiseAbs().maxCoeff());
  }
  if (reach == 0 || reach > kSmallest) return;
  throw BakeError(
      Problem{Severity::Error,
              "gltf.extreme-size",
              {file_of(mesh.file), fmt::format("/meshes/{}", mesh.geometry.mesh), 0, 0},
              fmt::format("coordinates reach {:.3g}; below {:.0e} the numbers of a file "
                          "lose their digits",
                          reach, kSmallest),
              "scale the mesh up, and the node down"});
}

using Point = std::array<double, 3>;

Point point_at(const Positions& positions, std::size_t row) {
  const double* p = positions.data() + 3 * row;
  return {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};  // turns -0 into 0, which is the same point
}

/// 32 bits that equal points share, and others hardly ever.
std::uint64_t hash_of(const Point& point) {
  std::uint64_t hash = 0;
  for (const double number : point) {
    hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15U;
  }
  return hash >> 32U;
}

/// Sorts by the upper 32 bits, digit by digit: comparing points instead waits for memory at every
/// step, which was three quarters of the time of reading a source (pipeline/bench, "load"). With
/// Boost's spreadsort in its place a source takes 1.1 to 1.2 times as long.
void sort_by_hash(std::vector<std::uint64_t>& entries) {
  constexpr unsigned kDigits = 3, kBits = 11;
  const auto digit = [](std::uint64_t entry, unsigned d) {
    return entry >> (32 + d * kBits) & ((1U << kBits) - 1);
  };
  std::array<std::array<std::uint32_t, (1U << kBits) + 1>, kDigits> begins{};
  for (const std::uint64_t entry : entries) {
    for (unsigned d = 0; d < kDigits; ++d) ++begins[d][digit(entry, d) + 1];
  }
  std::vector<std::uint64_t> sorted(entries.size());
  for (unsigned d = 0; d < kDigits; ++d) {
    std::partial_sum(begins[d].begin(), begins[d].end(), begins[d].begin());
    for (const std::uint64_t entry : entries) sorted[begins[d][digit(entry, d)]++] = entry;
    entries.swap(sorted);
  }
}

std::size_t row_of(std::uint64_t entry) { return entry & 0xFFFFFFFFU; }

/// Gives rows of one hash the first row that is equal.
void weld_run(const Positions& positions, std::span<std::uint64_t> entries,
              std::vector<int>& first) {
  const auto point = [&](std::uint64_t entry) { return point_at(positions, row_of(entry)); };
  if (entries.size() > 1) {
    std::sort(entries.begin(), entries.end(), [&](std::uint64_t a, std::uint64_t b) {
      const Point p = point(a), q = point(b);
      return p == q ? a < b : p < q;
    });
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const bool same = i > 0 && point(entries[i]) == point(entries[i - 1]);
    first[row_of(entries[i])] =
        same ? first[row_of(entries[i - 1])] : static_cast<int>(row_of(entries[i]));
  }
}

}  // namespace

Float3s file_normals(const SourceMesh& source) {
  Float3s normals(source.positions.rows(), 3);
  Eigen::Index begin = 0;
  for (const PrimitiveGeometry& primitive : source.geometry.primitives) {
    if (primitive.normals.rows() == 0) return {};
    normals.middleRows(begin, primitive.normals.rows()) = primitive.normals;
    begin += primitive.normals.rows();
  }
  return begin == normals.rows() ? normals : Float3s();
}

std::vector<int> weld_rows(const Positions& positions, int& welded_count) {
  const auto count = static_cast<std::size_t>(positions.rows());
  std::vector<std::uint64_t> entries(count);
  for (std::size_t i = 0; i < count; ++i) entries[i] = hash_of(point_at(positions, i)) << 32U | i;
  sort_by_hash(entries);
  std::vector<int> welded(count);  // at first the first row that is equal
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && entries[end] >> 32U == entries[begin] >> 32U) ++end;
    weld_run(positions, {entries.data() + begin, end - begin}, welded);
  }
  welded_count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto twin = static_cast<std::size_t>(welded[i]);
    welded[i] = twin == i ? welded_count++ : welded[twin];
  }
  return welded;
}

SourceMesh load_source(const SourceRef& source) {
  return read_source(source.name, open_gltf(source.file), source.choice);
}

SourceMesh read_source(const std::string& name, const GltfFile& file, const MeshChoice& choice) {
  SourceMesh mesh;
  mesh.name = name;
  mesh.file = file;
  mesh.geometry = read_source_geometry(mesh.file, choice);
  Eigen::Index vertices = 0, triangles = 0;
  for (const PrimitiveGeometry& primitive : mesh.geometry.primitives) {
    vertices += primitive.positions.rows();
    triangles += primitive.triangles.rows();
  }
  mesh.positions.resize(vertices, 3);
  mesh.triangles.resize(triangles, 3);
  vertices = triangles = 0;
  for (const PrimitiveGeometry& primitive : mesh.geometry.primitives) {
    to_scene(primitive.positions, mesh.geometry.to_scene,
             mesh.positions.middleRows(vertices, primitive.positions.rows()));
    mesh.triangles.middleRows(triangles, primitive.triangles.rows()) =
        primitive.triangles.array() + static_cast<int>(vertices);
    vertices += primitive.positions.rows();
    triangles += primitive.triangles.rows();
  }
  check_digits(mesh);
  check_size(mesh);
  mesh.welded = weld_rows(mesh.positions, mesh.welded_count);
  return mesh;
}

}  // namespace morphbake
