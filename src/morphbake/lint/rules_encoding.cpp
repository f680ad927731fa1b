#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "morphbake/lint/rules.h"

namespace morphbake {
namespace {

/// The faults of all attributes that `is_wrong`.
template <typename Test>
std::vector<Fault> faulty_attributes(const LintSubject& at, const Test& is_wrong,
                                     const std::string& message, const std::string& right) {
  std::vector<Fault> faults;
  for (const StoredAttribute* attribute : all_attributes(at.survey)) {
    if (is_wrong(attribute->accessor)) faults.push_back({attribute->pointer, message, right});
  }
  return first_of(std::move(faults));
}

bool is_sparse(const StoredAccessor& accessor) { return accessor.is_sparse; }

std::vector<Fault> check_sparse(const LintSubject& at) {
  if (at.profile.sparse != SparseSupport::None) return {};
  return faulty_attributes(at, is_sparse,
                           "the accessor is sparse, which " + at.profile.title + " does not read",
                           "write dense accessors, or quantized ones to save room");
}

std::vector<Fault> check_sparse_without_view(const LintSubject& at) {
  if (at.profile.sparse != SparseSupport::WithView) return {};
  return faulty_attributes(
      at, [](const StoredAccessor& accessor) { return accessor.is_sparse && accessor.view < 0; },
      "the sparse accessor has no bufferView, which " + at.profile.title + " reads as garbage",
      "give it a bufferView of zeros of its own, or write it dense");
}

std::vector<Fault> check_shared_view(const LintSubject& at) {
  if (at.profile.sparse_over_shared_view) return {};
  std::map<std::pair<int, std::size_t>, int> users;  // accessors over the same numbers
  std::map<int, const StoredAttribute*> by_accessor;
  for (const StoredAttribute* attribute : all_attributes(at.survey)) {
    by_accessor.emplace(attribute->accessor.index, attribute);
  }
  for (const auto& [index, attribute] : by_accessor) {
    if (attribute->accessor.view >= 0) {
      ++users[{attribute->accessor.view, attribute->accessor.offset}];
    }
  }
  return faulty_attributes(
      at,
      [&](const StoredAccessor& accessor) {
        return accessor.is_sparse && accessor.view >= 0 &&
               users[{accessor.view, accessor.offset}] > 1;
      },
      "the sparse accessor lies over numbers that another accessor shares, which " +
          at.profile.title + " reads wrong",
      "leave its bufferView out, or give it one of its own");
}

std::vector<Fault> check_zeros(const LintSubject& at) {
  if (at.profile.accessors_of_zeros) return {};
  return faulty_attributes(
      at, [](const StoredAccessor& accessor) { return !accessor.is_sparse && accessor.view < 0; },
      "the accessor has neither bufferView nor sparse: all zeros in glTF, but " + at.profile.title +
          " may read garbage",
      "write one sparse element of zeros, or a dense accessor");
}

bool uses(const MeshSurvey& survey, const char* extension) {
  return std::ranges::find(survey.extensions_used, extension) != survey.extensions_used.end();
}

bool is_float(const StoredAccessor& accessor) { return accessor.component_type == 5126; }

/// Whether an attribute needs KHR_mesh_quantization (glTF 2.0 alone has some integers).
bool is_quantized(const StoredAttribute& attribute) {
  const std::string& name = attribute.name;
  return !is_float(attribute.accessor) &&
         (name == "POSITION" || name == "NORMAL" || name == "TANGENT");
}

std::vector<Fault> check_quantization(const LintSubject& at) {
  if (at.profile.mesh_quantization) return {};
  std::vector<Fault> faults;
  for (const StoredAttribute* attribute : all_attributes(at.survey)) {
    if (!is_quantized(*attribute)) continue;
    faults.push_back({attribute->pointer,
                      attribute->name + " is quantized (KHR_mesh_quantization), which " +
                          at.profile.title + " does not read",
                      "write float32"});
  }
  if (faults.empty() && uses(at.survey, "KHR_mesh_quantization")) {
    faults.push_back(
        {"/extensionsUsed",
         "the file uses KHR_mesh_quantization, which " + at.profile.title + " does not read",
         "write float32"});
  }
  return first_of(std::move(faults));
}

std::vector<Fault> check_meshopt(const LintSubject& at) {
  if (at.profile.meshopt_compression || !uses(at.survey, "EXT_meshopt_compression")) return {};
  return {{"/extensionsUsed",
           "the file uses EXT_meshopt_compression, which " + at.profile.title + " does not read",
           "write it without compression"}};
}

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + fmt::format("{}", value);
  return "(" + text + ")";
}

/// JSON has decimals of float32 numbers.
bool are_equal(const StoredAccessor& accessor, const std::vector<double>& declared,
               const std::vector<double>& actual) {
  if (declared.size() != actual.size()) return false;
  for (std::size_t c = 0; c < declared.size(); ++c) {
    const bool is_same = is_float(accessor)
                             ? static_cast<float>(declared[c]) == static_cast<float>(actual[c])
                             : declared[c] == actual[c];
    if (!is_same) return false;
  }
  return true;
}

/// @param is_required  glTF wants bounds there
std::vector<Fault> bound_faults(const StoredAccessor& accessor, bool is_required,
                                const std::string& pointer) {
  if (accessor.actual_min.empty()) return {};
  const std::string place = fmt::format("/accessors/{}", accessor.index);
  const bool has_both = !accessor.declared_min.empty() && !accessor.declared_max.empty();
  if (!has_both) {
    if (!is_required) return {};
    return {
        {pointer, "the accessor has no min and max", "write the least and the largest numbers"}};
  }
  // A normalized -128 or -32768 counts as -127 or -32767.
  std::vector<double> low = accessor.declared_min;
  if (accessor.is_normalized && accessor.component_type == 5120) {
    for (double& number : low) number = std::max(number, -127.0);
  } else if (accessor.is_normalized && accessor.component_type == 5122) {
    for (double& number : low) number = std::max(number, -32767.0);
  }
  if (are_equal(accessor, low, accessor.actual_min) &&
      are_equal(accessor, accessor.declared_max, accessor.actual_max)) {
    return {};
  }
  return {{place,
           fmt::format("min {} and max {} are declared; the numbers go from {} to {}",
                       numbers(accessor.declared_min), numbers(accessor.declared_max),
                       numbers(accessor.actual_min), numbers(accessor.actual_max)),
           "clients cull and frame by the bounds: write the numbers' own"}};
}

std::vector<Fault> check_bounds(const LintSubject& at) {
  std::vector<Fault> faults;
  const auto add = [&](std::vector<Fault> found) {
    std::ranges::move(found, std::back_inserter(faults));
  };
  for (const StoredAttribute* attribute : all_attributes(at.survey)) {
    add(bound_faults(attribute->accessor, attribute->name == "POSITION", attribute->pointer));
  }
  for (const WeightsChannel& channel : at.survey.channels) {
    add(bound_faults(channel.times, true, channel.pointer + "/input"));
  }
  return first_of(std::move(faults));
}

constexpr CheckedRule kRules[] = {
    {{"sparse", FindingSeverity::Error, "sparse accessors, where the client reads none"},
     check_sparse},
    {{"sparse-without-view", FindingSeverity::Error,
      "sparse accessors without a bufferView, where the client needs one"},
     check_sparse_without_view},
    {{"sparse-over-shared-view", FindingSeverity::Error,
      "sparse accessors over numbers that other accessors share, where the client breaks on them"},
     check_shared_view},
    {{"accessor-of-zeros", FindingSeverity::Error,
      "accessors with neither bufferView nor sparse, where the client may read garbage"},
     check_zeros},
    {{"quantization", FindingSeverity::Error,
      "KHR_mesh_quantization, where the client does not read it"},
     check_quantization},
    {{"meshopt", FindingSeverity::Error,
      "EXT_meshopt_compression, where the client does not read it"},
     check_meshopt},
    {{"bounds", FindingSeverity::Error,
      "min and max of an accessor that are missing or not those of its numbers"},
     check_bounds},
};

}  // namespace

std::span<const CheckedRule> encoding_rules() { return kRules; }

}  // namespace morphbake
