#include "morphbake/gltf/vertex_attributes.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/source_geometry.h"

namespace morphbake {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Rows read_rows(const GltfDocument& document, int accessor, const std::string& pointer) {
  const int columns = accessor_columns(document, accessor, pointer);
  std::vector<float> numbers = read_floats(document, accessor, columns, pointer);
  return Eigen::Map<Rows>(numbers.data(), static_cast<Eigen::Index>(numbers.size()) / columns,
                          columns);
}

}  // namespace

VertexAttribute read_vertex_attribute(const GltfFile& file, int mesh, const std::string& name) {
  const auto& primitives = file->model.meshes[static_cast<std::size_t>(mesh)].primitives;
  VertexAttribute attribute;
  std::vector<Rows> blocks;
  std::set<std::string> names;
  Eigen::Index count = 0, columns = 0;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const std::string pointer = primitive_pointer(mesh, p) + "/attributes/";
    for (const auto& [each, accessor] : primitives[p].attributes) names.insert(each);
    const auto position = primitives[p].attributes.find("POSITION");
    const auto vertices =
        static_cast<Eigen::Index>(accessor_count(*file, position->second, pointer + "POSITION"));
    const auto found = primitives[p].attributes.find(name);
    attribute.is_given.push_back(found != primitives[p].attributes.end());
    Rows& rows = blocks.emplace_back(vertices, 0);
    count += vertices;
    if (!attribute.is_given.back()) continue;
    rows = read_rows(*file, found->second, pointer + name);
    if (rows.rows() != vertices || (columns > 0 && rows.cols() != columns)) {
      fail_at(*file, pointer + name, "gltf.accessor",
              fmt::format("the attribute has {} elements of {} numbers for {} positions",
                          rows.rows(), rows.cols(), vertices),
              "all primitives need as many numbers, one element a position");
    }
    columns = rows.cols();
  }
  attribute.names.assign(names.begin(), names.end());
  attribute.values = Eigen::MatrixXf::Zero(count, columns);
  Eigen::Index first = 0;
  for (const Rows& rows : blocks) {
    if (rows.cols() > 0) attribute.values.middleRows(first, rows.rows()) = rows;
    first += rows.rows();
  }
  return attribute;
}

std::vector<int> primitive_materials(const GltfFile& file, int mesh) {
  std::vector<int> materials;
  for (const auto& primitive : file->model.meshes[static_cast<std::size_t>(mesh)].primitives) {
    materials.push_back(primitive.material);
  }
  return materials;
}

std::vector<bool> normal_mapped_primitives(const GltfFile& file, int mesh) {
  const auto& materials = file->model.materials;
  std::vector<bool> are_mapped;
  for (const int material : primitive_materials(file, mesh)) {
    const auto at = static_cast<std::size_t>(material);
    const bool is_known = material >= 0 && at < materials.size();
    are_mapped.push_back(is_known && materials[at].normalTexture.index >= 0);
  }
  return are_mapped;
}

std::vector<std::string> material_names(const GltfFile& file) {
  std::vector<std::string> names;
  for (const auto& material : file->model.materials) names.push_back(material.name);
  return names;
}

int find_material(const GltfFile& file, const NameOrIndex& choice) {
  const std::vector<std::string> names = material_names(file);
  if (const int* index = std::get_if<int>(&choice)) {
    return *index < static_cast<int>(names.size()) ? *index : -1;
  }
  const auto found = std::find(names.begin(), names.end(), std::get<std::string>(choice));
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

}  // namespace morphbake
