#include "morphbake/transition/masks.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/files/files.h"
#include "morphbake/gltf/vertex_attributes.h"
#include "morphbake/images/images.h"
#include "morphbake/json/json.h"
#include "morphbake/json/nearest.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

/// A mask on its way to K.
struct MaskCarrier {
  const SourceMesh& source;
  const MaskRegion& mask;
  const MorphableMesh& mesh;
  Location where;
  Mesh surface = {};                    ///< of the source: its triangles that have an area
  std::vector<int> file_triangle = {};  ///< triangle of `surface` -> of the file
};

[[noreturn]] void fail(const MaskCarrier& carrier, const char* field, const std::string& message,
                       const std::string& hint) {
  throw BakeError(Problem{Severity::Error,
                          "recipe.mask",
                          {carrier.where.file, carrier.where.pointer + "/" + field, 0, 0},
                          message,
                          hint});
}

const Positions& geometry_of(const MaskCarrier& carrier) {
  return carrier.mesh.geometries[static_cast<std::size_t>(carrier.mask.source)];
}

/// Means over the render vertices of each point of the surface, one a render vertex.
Eigen::VectorXd welded_means(const SourceMesh& source, const Eigen::VectorXf& values) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(source.welded_count), counts = sums;
  for (std::size_t r = 0; r < source.welded.size(); ++r) {
    sums(source.welded[r]) += values(static_cast<Eigen::Index>(r));
    counts(source.welded[r]) += 1;
  }
  return (sums.array() / counts.array())(source.welded);
}

Eigen::VectorXd attribute_mask(const MaskCarrier& carrier, const AttributeMask& by) {
  const SourceMesh& source = carrier.source;
  const VertexAttribute attribute =
      read_vertex_attribute(source.file, source.geometry.mesh, by.name);
  if (attribute.values.cols() == 0) {
    fail(carrier, "attribute",
         fmt::format("the mesh of \"{}\" has no attribute {}", source.name, shown(Json(by.name))),
         name_hint(by.name, attribute.names, "its attributes"));
  }
  if (by.channel >= attribute.values.cols()) {
    fail(carrier, "channel",
         fmt::format("{} has no channel {}: it has {} numbers a vertex", by.name, by.channel,
                     attribute.values.cols()),
         "the first is 0");
  }
  const Eigen::VectorXd values = welded_means(source, attribute.values.col(by.channel));
  Eigen::VectorXd carried(geometry_of(carrier).rows());
  const auto points = closest_points(carrier.surface, geometry_of(carrier));
  for (std::size_t v = 0; v < points.size(); ++v) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      sum += points[v].barycentric(k) * values(carrier.surface.triangles(points[v].triangle, k));
    }
    carried(static_cast<Eigen::Index>(v)) = sum;
  }
  return carried;
}

/// Mean of red, green and blue between texels, as they stand in the file; repeated beyond 0 to 1.
double grey_at(const Image& image, const Eigen::Vector2d& uv) {
  const auto grey = [&](double x, double y) {
    const auto wrap = [](double i, int size) {
      const int rest = static_cast<int>(std::fmod(i, size));
      return static_cast<std::size_t>(rest < 0 ? rest + size : rest);
    };
    const std::size_t texel =
        wrap(y, image.height) * static_cast<std::size_t>(image.width) + wrap(x, image.width);
    const std::uint8_t* rgb = &image.rgb[3 * texel];
    return (rgb[0] + rgb[1] + rgb[2]) / (3 * 255.0);
  };
  const double x = (uv.x() - std::floor(uv.x())) * image.width - 0.5;
  const double y = (uv.y() - std::floor(uv.y())) * image.height - 0.5;
  const double left = std::floor(x), top = std::floor(y), a = x - left, b = y - top;
  return (1 - b) * ((1 - a) * grey(left, top) + a * grey(left + 1, top)) +
         b * ((1 - a) * grey(left, top + 1) + a * grey(left + 1, top + 1));
}

Image read_mask_image(const MaskCarrier& carrier, const ImageMask& by) {
  try {
    return decode_image(read_file(by.file, kMostImageBytes), by.file.string());
  } catch (const BakeError& error) {
    const Problem& problem = error.problems().front();
    fail(carrier, "image", fmt::format("{}: {}", by.file.string(), problem.message), problem.hint);
  }
}

/// What is known of each primitive, for each triangle of the file.
std::vector<bool> of_each_triangle(const SourceMesh& source, const std::vector<bool>& primitives) {
  std::vector<bool> triangles;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const Eigen::Index count = source.geometry.primitives[p].triangles.rows();
    triangles.insert(triangles.end(), static_cast<std::size_t>(count), primitives[p]);
  }
  return triangles;
}

/// Where the mesh has no texture coordinates nothing is marked.
Eigen::VectorXd image_mask(const MaskCarrier& carrier, const ImageMask& by) {
  const SourceMesh& source = carrier.source;
  const std::string name = fmt::format("TEXCOORD_{}", by.texcoord);
  const VertexAttribute uvs = read_vertex_attribute(source.file, source.geometry.mesh, name);
  if (uvs.values.cols() < 2) {
    fail(carrier, uvs.values.cols() == 0 && by.texcoord > 0 ? "texcoord" : "image",
         fmt::format("the mesh of \"{}\" has no texture coordinates {}", source.name, name),
         name_hint(name, uvs.names, "its attributes"));
  }
  const Image image = read_mask_image(carrier, by);
  const std::vector<bool> has_uvs = of_each_triangle(carrier.source, uvs.is_given);
  Eigen::VectorXd carried = Eigen::VectorXd::Zero(geometry_of(carrier).rows());
  const auto points = closest_points(carrier.surface, geometry_of(carrier));
  for (std::size_t v = 0; v < points.size(); ++v) {
    const int in_file = carrier.file_triangle[static_cast<std::size_t>(points[v].triangle)];
    if (!has_uvs[static_cast<std::size_t>(in_file)]) continue;
    Eigen::Vector2d uv = Eigen::Vector2d::Zero();
    for (int k = 0; k < 3; ++k) {
      const int render = carrier.surface.triangles(points[v].triangle, k);
      uv += points[v].barycentric(k) * uvs.values.row(render).head<2>().transpose().cast<double>();
    }
    carried(static_cast<Eigen::Index>(v)) = grey_at(image, uv);
  }
  return carried;
}

/// Vertices of the triangles that lie on marked primitives.
Eigen::VectorXd primitives_mask(const MaskCarrier& carrier, const std::vector<bool>& is_marked) {
  const std::vector<bool> triangle_is_marked = of_each_triangle(carrier.source, is_marked);
  const Triangles& triangles = carrier.mesh.connectivity.triangles;
  const Positions& positions = geometry_of(carrier);
  Positions middles(triangles.rows(), 3);
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    middles.row(f) = (positions.row(triangles(f, 0)) + positions.row(triangles(f, 1)) +
                      positions.row(triangles(f, 2))) /
                     3;
  }
  const auto points = closest_points(carrier.surface, middles);
  Eigen::VectorXd carried = Eigen::VectorXd::Zero(positions.rows());
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const int triangle = points[static_cast<std::size_t>(f)].triangle;
    const int in_file = carrier.file_triangle[static_cast<std::size_t>(triangle)];
    if (!triangle_is_marked[static_cast<std::size_t>(in_file)]) continue;
    for (int k = 0; k < 3; ++k) carried(triangles(f, k)) = 1;
  }
  return carried;
}

Eigen::VectorXd material_mask(const MaskCarrier& carrier, const MaterialMask& by) {
  const SourceMesh& source = carrier.source;
  const int material = find_material(source.file, by.material);
  if (material < 0) {
    const auto* name = std::get_if<std::string>(&by.material);
    const Json asked = name != nullptr ? Json(*name) : Json(std::get<int>(by.material));
    fail(carrier, "material",
         fmt::format("the file of \"{}\" has no material {}", source.name, shown(asked)),
         name_hint(name != nullptr ? *name : "", material_names(source.file), "its materials"));
  }
  std::vector<bool> is_marked;
  for (const int each : primitive_materials(source.file, source.geometry.mesh)) {
    is_marked.push_back(each == material);
  }
  return primitives_mask(carrier, is_marked);
}

Eigen::VectorXd primitive_mask(const MaskCarrier& carrier, const PrimitiveMask& by) {
  const std::size_t count = carrier.source.geometry.primitives.size();
  if (static_cast<std::size_t>(by.primitive) >= count) {
    fail(carrier, "primitive",
         fmt::format("the mesh of \"{}\" has no primitive {}: it has {}", carrier.source.name,
                     by.primitive, count),
         "the first is 0");
  }
  std::vector<bool> is_marked(count, false);
  is_marked[static_cast<std::size_t>(by.primitive)] = true;
  return primitives_mask(carrier, is_marked);
}

Eigen::VectorXd values_of(MaskCarrier carrier) {
  const Positions& positions = carrier.source.positions;
  const Triangles& triangles = carrier.source.triangles;
  carrier.file_triangle = triangles_with_area(positions, triangles);
  carrier.surface = {positions, triangles(carrier.file_triangle, Eigen::all)};
  const auto& by = carrier.mask.by;
  Eigen::VectorXd values;
  if (const auto* attribute = std::get_if<AttributeMask>(&by)) {
    values = attribute_mask(carrier, *attribute);
  } else if (const auto* material = std::get_if<MaterialMask>(&by)) {
    values = material_mask(carrier, *material);
  } else if (const auto* primitive = std::get_if<PrimitiveMask>(&by)) {
    values = primitive_mask(carrier, *primitive);
  } else {
    values = image_mask(carrier, std::get<ImageMask>(by));
  }
  return values.cwiseMax(0).cwiseMin(1);
}

}  // namespace

std::vector<Eigen::VectorXd> mask_values(const MorphableMesh& mesh, const Recipe& recipe,
                                         const std::vector<SourceMesh>& originals) {
  std::vector<Eigen::VectorXd> values(recipe.regions.size());
  for (std::size_t r = 0; r < values.size(); ++r) {
    const auto* mask = std::get_if<MaskRegion>(&recipe.regions[r].shape);
    if (mask == nullptr) continue;
    const Location where =
        location_in(recipe, child_pointer("/regions", recipe.regions[r].name) + "/mask");
    values[r] = values_of({originals[static_cast<std::size_t>(mask->source)], *mask, mesh, where});
  }
  return values;
}

}  // namespace morphbake
