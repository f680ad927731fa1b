#include "morphbake/diff/mesh_findings.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>

#include "morphbake/diagnostics/counted.h"
#include "morphbake/gltf/vertex_attributes.h"

namespace morphbake {
namespace {

constexpr double kBoundsRounding = 1e-6;  // of a number: bounds are written as decimals

/// What is found, and by which measure.
struct Comparison {
  const OpenMesh& a;
  const OpenMesh& b;
  const DiffOptions& options;
  std::vector<Finding> findings;

  void differ(std::string kind, std::string message) {
    findings.push_back({true, std::move(kind), std::move(message)});
  }

  /// A difference only where all is to be the same.
  void mention(std::string kind, std::string message) {
    findings.push_back({options.strict, std::move(kind), std::move(message)});
  }
};

std::string quoted(const std::string& name) { return '"' + name + '"'; }

/// "POSITION, NORMAL", or "none".
std::string listed(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

/// Triangles that begin with their smallest vertex, in rising order: the same whatever the order
/// and the first corner, not the same when one is turned round.
std::vector<std::array<int, 3>> sorted_triangles(const TriangleIndices& triangles) {
  std::vector<std::array<int, 3>> sorted;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    std::array<int, 3> corners = {triangles(f, 0), triangles(f, 1), triangles(f, 2)};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    sorted.push_back(corners);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

void compare_triangles(std::size_t p, Comparison& comparison) {
  const TriangleIndices& a = comparison.a.mesh.primitives[p].triangles;
  const TriangleIndices& b = comparison.b.mesh.primitives[p].triangles;
  if (a.rows() != b.rows()) {
    return comparison.differ(
        "triangles", fmt::format("primitive {}: {} triangles against {}", p, a.rows(), b.rows()));
  }
  if (a == b) return;
  const auto in_a = sorted_triangles(a), in_b = sorted_triangles(b);
  if (in_a == in_b) {
    return comparison.mention("triangle-order",
                              fmt::format("primitive {}: the same triangles in another order", p));
  }
  std::vector<std::array<int, 3>> only_a;
  std::set_difference(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                      std::back_inserter(only_a));
  comparison.differ(
      "triangles",
      fmt::format("primitive {}: {} of {} triangles join other vertices, the first of "
                  "them {}, {}, {}",
                  p, only_a.size(), a.rows(), only_a[0][0], only_a[0][1], only_a[0][2]));
}

void compare_facts(const PrimitiveFacts& a, const PrimitiveFacts& b, std::size_t p,
                   Comparison& comparison) {
  if (a.attributes != b.attributes) {
    comparison.differ("attributes", fmt::format("primitive {}: {} against {}", p,
                                                listed(a.attributes), listed(b.attributes)));
  }
  if (a.target_attributes != b.target_attributes) {
    comparison.differ("target-attributes",
                      fmt::format("primitive {}: targets have {} against {}", p,
                                  listed(a.target_attributes), listed(b.target_attributes)));
  }
}

bool are_close(const auto& a, const auto& b, double tolerance) {
  return (a - b).cwiseAbs().maxCoeff() <= tolerance;
}

/// What two materials do not have in common, by glTF's names.
std::vector<std::string> unequal_fields(const MaterialFacts& a, const MaterialFacts& b,
                                        double tolerance) {
  std::vector<std::string> fields;
  const auto check = [&](bool is_equal, const char* name) {
    if (!is_equal) fields.emplace_back(name);
  };
  const auto is_close = [&](double x, double y) { return std::abs(x - y) <= tolerance; };
  check(are_close(a.base_colour, b.base_colour, tolerance), "baseColorFactor");
  check(is_close(a.metallic, b.metallic), "metallicFactor");
  check(is_close(a.roughness, b.roughness), "roughnessFactor");
  check(are_close(a.emissive, b.emissive, tolerance), "emissiveFactor");
  check(a.alpha_mode == b.alpha_mode, "alphaMode");
  check(is_close(a.alpha_cutoff, b.alpha_cutoff), "alphaCutoff");
  check(a.double_sided == b.double_sided, "doubleSided");
  return fields;
}

void compare_materials(const PrimitiveFacts& facts_a, const PrimitiveFacts& facts_b, std::size_t p,
                       Comparison& comparison) {
  const MaterialFacts a = material_facts(comparison.a.file, facts_a.material);
  const MaterialFacts b = material_facts(comparison.b.file, facts_b.material);
  if (a.name != b.name) {
    comparison.differ("material", fmt::format("primitive {}: material {} against {}", p,
                                              quoted(a.name), quoted(b.name)));
  }
  const std::vector<std::string> fields = unequal_fields(a, b, comparison.options.attribute);
  if (fields.empty()) return;
  comparison.differ("material-values", fmt::format("primitive {}: material {} has other {}", p,
                                                   quoted(a.name), listed(fields)));
}

void compare_textures(std::size_t p, Comparison& comparison) {
  const AnimatedMesh &a = comparison.a.mesh, &b = comparison.b.mesh;
  const int in_a = a.primitives[p].image, in_b = b.primitives[p].image;
  if ((in_a < 0) != (in_b < 0)) {
    return comparison.differ(
        "texture", fmt::format("primitive {}: a base-colour texture in the {} file only", p,
                               in_a < 0 ? "second" : "first"));
  }
  if (in_a < 0) return;
  if (a.images[static_cast<std::size_t>(in_a)] != b.images[static_cast<std::size_t>(in_b)]) {
    comparison.differ(
        "texture", fmt::format("primitive {}: another base-colour picture, {} against {} bytes", p,
                               a.images[static_cast<std::size_t>(in_a)].size(),
                               b.images[static_cast<std::size_t>(in_b)].size()));
  }
}

/// Tells where two lists of rows are furthest apart.
template <typename Rows>
void compare_rows(const std::string& name, std::size_t p, const Rows& a, const Rows& b,
                  Comparison& comparison) {
  if (a.rows() != b.rows() || a.size() == 0) return;  // told as "vertices" or "attributes"
  if (a.cols() != b.cols()) {
    return comparison.differ("attribute-values",
                             fmt::format("primitive {}: {} has {} numbers a vertex against {}", p,
                                         name, a.cols(), b.cols()));
  }
  Eigen::Index row = 0, column = 0;
  const double largest = static_cast<double>((a - b).cwiseAbs().maxCoeff(&row, &column));
  if (largest <= comparison.options.attribute) return;
  comparison.differ("attribute-values",
                    fmt::format("primitive {}: {} differs by {:.3g} at vertex {} ({:.6g} against "
                                "{:.6g}); {:.3g} is allowed",
                                p, name, largest, row, a(row, column), b(row, column),
                                comparison.options.attribute));
}

/// The first row of each primitive in VertexAttribute, and the end.
std::vector<Eigen::Index> first_rows(const AnimatedMesh& mesh) {
  std::vector<Eigen::Index> first{0};
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    first.push_back(first.back() + primitive.positions.rows());
  }
  return first;
}

/// Whether the numbers of an attribute are compared as they stand. Positions and normals are
/// compared in motion; colours by their red, green and blue; coordinates of the base colour after
/// the material has placed them.
bool is_compared_plainly(const std::string& name, const Comparison& comparison, std::size_t p) {
  if (name == "POSITION" || name == "NORMAL" || name == "COLOR_0") return false;
  return !name.starts_with("TEXCOORD_") ||
         comparison.a.mesh.primitives[p].texture_coordinates.rows() == 0 ||
         comparison.b.mesh.primitives[p].texture_coordinates.rows() == 0;
}

void compare_attributes(const std::vector<std::size_t>& primitives, Comparison& comparison) {
  const std::vector<PrimitiveFacts> facts_a =
      primitive_facts(comparison.a.file, comparison.a.at.mesh);
  const std::vector<PrimitiveFacts> facts_b =
      primitive_facts(comparison.b.file, comparison.b.at.mesh);
  std::set<std::string> names;
  for (const std::size_t p : primitives) {
    std::set_intersection(facts_a[p].attributes.begin(), facts_a[p].attributes.end(),
                          facts_b[p].attributes.begin(), facts_b[p].attributes.end(),
                          std::inserter(names, names.end()));
  }
  const std::vector<Eigen::Index> first_a = first_rows(comparison.a.mesh);
  const std::vector<Eigen::Index> first_b = first_rows(comparison.b.mesh);
  for (const std::string& name : names) {
    if (name == "POSITION" || name == "NORMAL" || name == "COLOR_0") continue;
    const VertexAttribute a = read_vertex_attribute(comparison.a.file, comparison.a.at.mesh, name);
    const VertexAttribute b = read_vertex_attribute(comparison.b.file, comparison.b.at.mesh, name);
    for (const std::size_t p : primitives) {
      if (!a.is_given[p] || !b.is_given[p] || !is_compared_plainly(name, comparison, p)) continue;
      const Eigen::Index count = first_a[p + 1] - first_a[p];
      compare_rows<Eigen::MatrixXf>(name, p, a.values.middleRows(first_a[p], count),
                                    b.values.middleRows(first_b[p], count), comparison);
    }
  }
  for (const std::size_t p : primitives) {
    const AnimatedPrimitive& in_a = comparison.a.mesh.primitives[p];
    const AnimatedPrimitive& in_b = comparison.b.mesh.primitives[p];
    compare_rows("COLOR_0", p, in_a.colours, in_b.colours, comparison);
    compare_rows("the base colour's TEXCOORD", p, in_a.texture_coordinates,
                 in_b.texture_coordinates, comparison);
  }
}

void compare_target_names(Comparison& comparison) {
  const std::vector<std::string>& a = comparison.a.mesh.target_names;
  const std::vector<std::string>& b = comparison.b.mesh.target_names;
  if (a == b) return;
  if (a.size() != b.size()) {
    return comparison.mention(
        "targets", fmt::format("{} against {}",
                               counted(static_cast<int>(a.size()), "morph target", "morph targets"),
                               b.size()));
  }
  const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin());
  comparison.mention("targets", fmt::format("morph target {} is called {} against {}",
                                            in_a - a.begin(), quoted(*in_a), quoted(*in_b)));
}

Eigen::AlignedBox3f bounds_of(const Float3s& rows) {
  Eigen::AlignedBox3f box;
  for (Eigen::Index v = 0; v < rows.rows(); ++v) {
    box.extend(Eigen::Vector3f(rows(v, 0), rows(v, 1), rows(v, 2)));
  }
  return box;
}

/// Bounds that do not hold, each as one line.
std::vector<std::string> wrong_bounds(const OpenMesh& open) {
  std::vector<std::string> wrong;
  for (const StatedBounds& stated : stated_bounds(open.file, open.at.mesh)) {
    const bool is_base = stated.target < 0;
    const Eigen::AlignedBox3f box =
        is_base ? bounds_of(open.mesh.primitives[stated.primitive].positions)
                : open.targets.bounds(stated.primitive, static_cast<std::size_t>(stated.target));
    if (box.isEmpty()) continue;
    const Eigen::Vector3d min = box.min().cast<double>(), max = box.max().cast<double>();
    const double rounding =
        kBoundsRounding * std::max(min.cwiseAbs().maxCoeff(), max.cwiseAbs().maxCoeff());
    if (are_close(min, stated.min, rounding) && are_close(max, stated.max, rounding)) continue;
    wrong.push_back(fmt::format(
        "primitive {}, {}: ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) is stated, "
        "({:.6g}, "
        "{:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) is there",
        stated.primitive, is_base ? "POSITION" : fmt::format("target {}", stated.target),
        stated.min.x(), stated.min.y(), stated.min.z(), stated.max.x(), stated.max.y(),
        stated.max.z(), min.x(), min.y(), min.z(), max.x(), max.y(), max.z()));
  }
  return wrong;
}

/// Bounds are a difference when they hold in one file only.
void compare_bounds(Comparison& comparison) {
  const std::vector<std::string> a = wrong_bounds(comparison.a), b = wrong_bounds(comparison.b);
  if (a.empty() && b.empty()) return;
  const bool is_difference = a.empty() != b.empty();
  const auto tell = [&](const char* which, const std::vector<std::string>& wrong) {
    if (wrong.empty()) return;
    const std::string more =
        wrong.size() > 1 ? fmt::format(" (and {} more)", wrong.size() - 1) : "";
    comparison.findings.push_back(
        {is_difference, "bounds",
         fmt::format("bounds that are not so in the {} file: {}{}", which, wrong[0], more)});
  };
  tell("first", a);
  tell("second", b);
}

}  // namespace

std::vector<std::size_t> comparable_primitives(const OpenMesh& a, const OpenMesh& b) {
  std::vector<std::size_t> primitives;
  const std::size_t count = std::min(a.mesh.primitives.size(), b.mesh.primitives.size());
  for (std::size_t p = 0; p < count; ++p) {
    const bool are_as_many =
        a.mesh.primitives[p].positions.rows() == b.mesh.primitives[p].positions.rows();
    if (are_as_many) primitives.push_back(p);
  }
  return primitives;
}

std::vector<Finding> mesh_findings(const OpenMesh& a, const OpenMesh& b,
                                   const DiffOptions& options) {
  Comparison comparison{a, b, options, {}};
  const std::vector<AnimatedPrimitive>&in_a = a.mesh.primitives, &in_b = b.mesh.primitives;
  if (in_a.size() != in_b.size()) {
    comparison.differ("primitives",
                      fmt::format("{} against {}",
                                  counted(static_cast<int>(in_a.size()), "primitive", "primitives"),
                                  in_b.size()));
  }
  const std::vector<PrimitiveFacts> facts_a = primitive_facts(a.file, a.at.mesh);
  const std::vector<PrimitiveFacts> facts_b = primitive_facts(b.file, b.at.mesh);
  for (std::size_t p = 0; p < std::min(in_a.size(), in_b.size()); ++p) {
    if (in_a[p].positions.rows() != in_b[p].positions.rows()) {
      comparison.differ("vertices",
                        fmt::format("primitive {}: {} vertices against {}", p,
                                    in_a[p].positions.rows(), in_b[p].positions.rows()));
    }
    compare_triangles(p, comparison);
    compare_facts(facts_a[p], facts_b[p], p, comparison);
    compare_materials(facts_a[p], facts_b[p], p, comparison);
    compare_textures(p, comparison);
  }
  compare_attributes(comparable_primitives(a, b), comparison);
  compare_target_names(comparison);
  compare_bounds(comparison);
  return comparison.findings;
}

}  // namespace morphbake
