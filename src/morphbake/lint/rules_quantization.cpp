#include <fmt/core.h>

#include <array>
#include <cmath>

#include "morphbake/lint/rules.h"

namespace morphbake {
namespace {

constexpr int kFloat = 5126;

const StoredAttribute* find_attribute(const std::vector<StoredAttribute>& attributes,
                                      const char* name) {
  for (const StoredAttribute& attribute : attributes) {
    if (attribute.name == name) return &attribute;
  }
  return nullptr;
}

bool is_normalized(const StoredAttribute* attribute) {
  return attribute != nullptr && attribute->accessor.is_normalized &&
         attribute->accessor.component_type != kFloat;
}

/// Bytes of a number.
std::size_t width_of(const StoredAccessor& accessor) {
  const bool is_byte = accessor.component_type == 5120 || accessor.component_type == 5121;
  const bool is_short = accessor.component_type == 5122 || accessor.component_type == 5123;
  return is_byte ? 1 : is_short ? 2 : 4;
}

std::vector<Fault> check_stride(const LintSubject& at) {
  std::vector<Fault> faults;
  for (const StoredAttribute* attribute : all_attributes(at.survey)) {
    const StoredAccessor& accessor = attribute->accessor;
    if (accessor.view < 0) continue;
    const std::size_t element = width_of(accessor) * static_cast<std::size_t>(accessor.columns);
    const std::size_t stride = accessor.stride > 0 ? accessor.stride : element;
    if (stride % 4 == 0 && accessor.offset % 4 == 0) continue;
    faults.push_back(
        {attribute->pointer,
         fmt::format("elements of {} bytes follow one another every {} bytes, from byte {} on",
                     element, stride, accessor.offset),
         fmt::format("vertex attributes lie at multiples of 4 bytes: give the bufferView a "
                     "byteStride of {}",
                     (element + 3) / 4 * 4)});
  }
  return first_of(std::move(faults));
}

/// Whether vertices of a target look cut off at 1: several, moved differently, end on it along one
/// axis. A single largest one, or all alike, is how a good scale looks.
bool looks_cut_off(const Float3s& displacement) {
  constexpr int kSeveral = 3;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float limit : {-1.0F, 1.0F}) {
      int count = 0;
      bool differ = false;
      Eigen::Index first = -1;
      for (Eigen::Index v = 0; v < displacement.rows(); ++v) {
        if (displacement(v, axis) != limit) continue;
        ++count;
        if (first < 0) first = v;
        differ = differ || displacement.row(v) != displacement.row(first);
      }
      if (count >= kSeveral && differ) return true;
    }
  }
  return false;
}

std::vector<Fault> check_range(const LintSubject& at) {
  std::vector<Fault> faults;
  for (std::size_t p = 0; p < at.survey.primitives.size(); ++p) {
    const StoredPrimitive& stored = at.survey.primitives[p];
    for (std::size_t t = 0; t < stored.targets.size(); ++t) {
      const StoredAttribute* position = find_attribute(stored.targets[t], "POSITION");
      if (!is_normalized(position)) continue;
      if (!looks_cut_off(at.survey.mesh.primitives[p].target_positions[t])) continue;
      faults.push_back({position->pointer,
                        "displacements end on exactly 1, as if larger ones were cut off",
                        "a normalized delta is at most 1: put a larger scale on the node"});
    }
  }
  return first_of(std::move(faults));
}

/// Vertices whose normal was cut off: a component of the delta is 1, and the sum is no unit vector.
int cut_off_normals(const Float3s& normals, const Float3s& deltas) {
  constexpr float kUnit = 0.05F;  // what 8 bits lose is less
  int count = 0;
  for (Eigen::Index v = 0; v < std::min(normals.rows(), deltas.rows()); ++v) {
    if (deltas.row(v).cwiseAbs().maxCoeff() < 1) continue;
    const float length = (normals.row(v) + deltas.row(v)).norm();
    count += std::abs(length - 1) > kUnit ? 1 : 0;
  }
  return count;
}

std::vector<Fault> check_normals(const LintSubject& at) {
  std::vector<Fault> faults;
  for (std::size_t p = 0; p < at.survey.primitives.size(); ++p) {
    const StoredPrimitive& stored = at.survey.primitives[p];
    const AnimatedPrimitive& read = at.survey.mesh.primitives[p];
    for (std::size_t t = 0; t < stored.targets.size(); ++t) {
      const StoredAttribute* normal = find_attribute(stored.targets[t], "NORMAL");
      if (!is_normalized(normal)) continue;
      const int count = cut_off_normals(read.normals, read.target_normals[t]);
      if (count == 0) continue;
      faults.push_back({normal->pointer,
                        fmt::format("normals of {} vertices were cut off: their deltas are 1, but "
                                    "normal and delta make no unit vector",
                                    count),
                        "deltas of normals reach 2, and normalized numbers end at 1: write the "
                        "NORMAL of targets as float32"});
    }
  }
  return first_of(std::move(faults));
}

std::vector<Fault> check_node(const LintSubject& at) {
  bool is_quantized = false;
  for (const StoredPrimitive& primitive : at.survey.primitives) {
    const StoredAttribute* position = find_attribute(primitive.attributes, "POSITION");
    is_quantized = is_quantized || (position && position->accessor.component_type != kFloat);
  }
  const bool is_shared = at.survey.has_children || at.survey.has_skin;
  if (!is_quantized || !at.survey.has_scale || !is_shared) return {};
  return {{at.survey.node_pointer,
           at.survey.has_skin
               ? "the scale of a quantized mesh is on a node with a skin, which ignores it"
               : "the scale of a quantized mesh is on a node with children, which it scales too",
           "put the scale on a node of its own below it"}};
}

constexpr CheckedRule kRules[] = {
    {{"attribute-stride", FindingSeverity::Error,
      "vertex attributes off multiples of 4 bytes: int16 VEC3 needs a byteStride of 8"},
     check_stride},
    {{"quantized-range", FindingSeverity::Warning,
      "normalized deltas of positions that look cut off at 1"},
     check_range},
    {{"quantized-normals", FindingSeverity::Warning,
      "normalized deltas of normals that were cut off at 1"},
     check_normals},
    {{"quantized-node", FindingSeverity::Warning,
      "a quantized mesh whose scale sits on a node with children or a skin"},
     check_node},
};

}  // namespace

std::span<const CheckedRule> quantization_rules() { return kRules; }

}  // namespace morphbake
