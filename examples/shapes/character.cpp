// SPDX-License-Identifier: GPL-3.0-or-later
#include "character.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "coat.h"
#include "paint.h"
#include "unwrap.h"

namespace shapes {
namespace {

constexpr int texture_size = 512;

/// In the order of the primitives.
const std::array<std::pair<Fabric, Material>, 3> materials{
    {{Fabric::Fur, {"fur", 0.85, true}},
     {Fabric::Wool, {"wool", 1.0, true}},
     {Fabric::Gloss, {"gloss", 0.25, false}}}};

Mesh joined(const Mesh& a, const Mesh& b) {
  Mesh both;
  both.positions.resize(a.positions.rows() + b.positions.rows(), 3);
  both.positions << a.positions, b.positions;
  both.colors.resize(both.positions.rows(), 3);
  both.colors << a.colors, b.colors;
  both.triangles.resize(a.triangles.rows() + b.triangles.rows(), 3);
  both.triangles << a.triangles, b.triangles.array() + static_cast<int>(a.positions.rows());
  return both;
}

Vector centre_of(const Mesh& mesh, Eigen::Index f) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (int k = 0; k < 3; ++k) sum += mesh.positions.row(mesh.triangles(f, k));
  return sum.transpose() / 3;
}

Vector normal_of(const Mesh& mesh, Eigen::Index f) {
  const auto at = [&](int k) -> Eigen::Vector3d {
    return mesh.positions.row(mesh.triangles(f, k)).transpose();
  };
  return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
}

/// What each triangle is made of, and which chart it would like to be in.
struct Cut {
  std::vector<Fabric> fabrics;
  std::vector<int> labels;
};

void cut(const Mesh& mesh, const Solid& solid, std::map<std::string, int>& numbers, Cut& result) {
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    const Part& part = part_at(solid, centre_of(mesh, f));
    const auto front = solid.fronts.find(part.group);
    const Vector facing = front == solid.fronts.end() ? Vector::UnitZ() : front->second;
    const int group =
        numbers.try_emplace(part.group, static_cast<int>(numbers.size())).first->second;
    result.fabrics.push_back(part.skin.fabric);
    result.labels.push_back(2 * group + (normal_of(mesh, f).dot(facing) > 0));
  }
}

/// The triangles of one fabric, their vertices split along the seams.
Primitive primitive_of(const Mesh& mesh, const Cut& cut, const Unwrapped& flat,
                       const std::pair<Fabric, Material>& made_of) {
  const bool is_textured = made_of.second.is_textured;
  std::map<std::pair<int, int>, int> index;        // of vertex and chart
  std::vector<std::pair<int, Eigen::Index>> rows;  // vertex and corner
  std::vector<Eigen::RowVector3i> triangles;
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    const auto triangle = static_cast<std::size_t>(f);
    if (cut.fabrics[triangle] != made_of.first) continue;
    const int chart = is_textured ? flat.charts[triangle] : 0;
    Eigen::RowVector3i& corners = triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(f, k);
      const auto [entry, is_new] = index.try_emplace({v, chart}, static_cast<int>(rows.size()));
      if (is_new) rows.emplace_back(v, 3 * f + k);
      corners[k] = entry->second;
    }
  }
  const Rows3d normals = vertex_normals(mesh);
  const auto count = static_cast<Eigen::Index>(rows.size());
  Primitive result{made_of.second,
                   Rows3d(count, 3),
                   Rows3d(count, 3),
                   Rows3d(is_textured ? 0 : count, 3),
                   Rows2d(is_textured ? count : 0, 2),
                   Rows3i(static_cast<Eigen::Index>(triangles.size()), 3)};
  for (Eigen::Index r = 0; r < count; ++r) {
    const auto [vertex, corner] = rows[static_cast<std::size_t>(r)];
    result.positions.row(r) = mesh.positions.row(vertex);
    result.normals.row(r) = normals.row(vertex);
    if (is_textured) {
      result.uv.row(r) = flat.uv.row(corner);
    } else {
      result.colors.row(r) = mesh.colors.row(vertex);
    }
  }
  for (std::size_t f = 0; f < triangles.size(); ++f)
    result.triangles.row(static_cast<Eigen::Index>(f)) = triangles[f];
  return result;
}

Mesh built(const Mesh& mesh, const Solid& solid, const Variant& build) {
  Mesh result = build.stretches.empty() ? mesh : varied(mesh, solid, build);
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v)
    result.colors.row(v) = color(solid, mesh.positions.row(v).transpose()).transpose();
  return result;
}

}  // namespace

std::vector<Dressed> dressed(const std::vector<Look>& looks) {
  const Look& first = looks.front();
  const Mesh body = mesh_surface(first.body);
  const Mesh hat = mesh_surface(first.hat);
  const Mesh both = joined(body, hat);
  std::vector<LandmarkHint> hints = first.body.landmarks;
  hints.insert(hints.end(), first.hat.landmarks.begin(), first.hat.landmarks.end());
  const std::vector<Landmark> landmarks = find_landmarks(both, hints);
  std::map<std::string, int> groups;
  Cut pieces;
  cut(body, first.body, groups, pieces);
  cut(hat, first.hat, groups, pieces);
  const Unwrapped flat = unwrap(both, pieces.labels);

  std::vector<Dressed> results;
  for (const Look& look : looks) {
    const Mesh built_body = built(body, look.body, look.build);
    const Mesh built_hat = built(hat, look.hat, look.build);
    check(built_body, look.build.name, Topology::Sphere);
    check(built_hat, look.build.name + "'s hat", Topology::Sphere);
    Dressed& result = results.emplace_back(
        Dressed{look.build.name, joined(built_body, built_hat), {}, landmarks});
    stand_on_floor(result.mesh);
    result.model.texture = paint(both, flat, texture_size, [&](int triangle, const Vector& at) {
      return coat_color(triangle < body.triangles.rows() ? look.body : look.hat, at);
    });
    for (const auto& material : materials)
      result.model.primitives.push_back(primitive_of(result.mesh, pieces, flat, material));
  }
  return results;
}

}  // namespace shapes
