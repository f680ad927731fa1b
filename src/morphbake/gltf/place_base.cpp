#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "morphbake/gltf/morph_writing.h"
#include "morphbake/gltf/primitive_geometry.h"
#include "morphbake/gltf/replace_accessor.h"

namespace morphbake {
namespace {

/// One attribute of the mesh's primitives: new rows for their accessors.
struct NewAttribute {
  std::string name;
  std::vector<Float3s> rows;  ///< one a primitive; none: stays
};

bool is_used(const PrimitiveMorph& primitive, Eigen::Index row) {
  return primitive.is_used.empty() || primitive.is_used[static_cast<std::size_t>(row)];
}

/// Primitives that share an accessor, of which each uses some of the vertices.
struct Sharing {
  int accessor = 0;
  std::vector<std::size_t> primitives;
};

/// Rows that are right for all of the primitives: each vertex is where the primitive that uses it
/// has it. None when two of them have one vertex at different places, by targets of their own.
Float3s common_rows(const MeshMorph& morph, const NewAttribute& attribute, const Sharing& sharing) {
  Float3s common = attribute.rows[sharing.primitives.front()];
  std::vector<bool> is_set(static_cast<std::size_t>(common.rows()), false);
  for (const std::size_t p : sharing.primitives) {
    const Float3s& rows = attribute.rows[p];
    for (Eigen::Index r = 0; r < common.rows(); ++r) {
      const auto at = static_cast<std::size_t>(r);
      if (!is_used(morph.primitives[p], r)) continue;
      if (is_set[at] && common.row(r) != rows.row(r)) return {};
      common.row(r) = rows.row(r);
      is_set[at] = true;
    }
  }
  return common;
}

/// Gives primitives that share an accessor these rows.
void put_rows(MorphWriting& writing, const std::string& name, const Sharing& sharing,
              const Float3s& rows) {
  const int written =
      replace_accessor(writing.draft, writing.references,
                       {sharing.accessor, static_cast<int>(sharing.primitives.size())},
                       {rows.data(), static_cast<std::size_t>(rows.rows()), 3});
  Json& primitives = mesh_of(writing)["primitives"];
  for (const std::size_t p : sharing.primitives) primitives[p]["attributes"][name] = written;
}

void replace_attribute(MorphWriting& writing, const NewAttribute& attribute) {
  const Json& primitives = mesh_of(writing)["primitives"];
  std::map<int, std::vector<std::size_t>> users;  // of an accessor
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const Json& attributes = primitives[p]["attributes"];
    if (attribute.rows[p].rows() > 0 && attributes.contains(attribute.name)) {
      users[attributes[attribute.name].get<int>()].push_back(p);
    }
  }
  for (const auto& [accessor, sharing] : users) {
    const Float3s common = common_rows(writing.morph, attribute, {accessor, sharing});
    if (common.rows() > 0) {
      put_rows(writing, attribute.name, {accessor, sharing}, common);
      continue;
    }
    for (const std::size_t p : sharing) {
      put_rows(writing, attribute.name, {accessor, {p}}, attribute.rows[p]);
    }
  }
}

}  // namespace

void place_base(MorphWriting& writing) {
  const MeshMorph& morph = writing.morph;
  const tinygltf::Mesh& mesh = writing.document.model.meshes[static_cast<std::size_t>(morph.mesh)];
  const Eigen::VectorXd rest = own_weights(writing);
  NewAttribute positions{"POSITION", {}}, normals{"NORMAL", {}};
  for (std::size_t p = 0; p < morph.primitives.size(); ++p) {
    const PrimitiveMorph& primitive = morph.primitives[p];
    positions.rows.push_back(primitive.positions);
    normals.rows.push_back(primitive.normals);
    for (std::size_t t = 0; t < writing.own_targets; ++t) {
      const auto weight = static_cast<float>(rest(static_cast<Eigen::Index>(t)));
      if (weight == 0) continue;
      const TargetGeometry target =
          read_target(writing.document, mesh.primitives[p], t, primitive.positions.rows(),
                      primitive_pointer(morph.mesh, p));
      if (target.positions.rows() > 0) positions.rows[p] -= weight * target.positions;
      if (target.normals.rows() > 0 && primitive.normals.rows() > 0) {
        normals.rows[p] -= weight * target.normals;
      }
    }
  }
  replace_attribute(writing, positions);
  replace_attribute(writing, normals);
}

void place_colours(MorphWriting& writing) {
  NewAttribute colours{"COLOR_0", {}};
  for (const PrimitiveMorph& primitive : writing.morph.primitives) {
    colours.rows.push_back(primitive.colours);
  }
  replace_attribute(writing, colours);
}

}  // namespace morphbake
