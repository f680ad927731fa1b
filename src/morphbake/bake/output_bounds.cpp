#include "morphbake/bake/output_bounds.h"

#include <fmt/core.h>

#include <utility>

namespace morphbake {
namespace {

/// Tells that a bound is not kept: an error, or a warning where the recipe says so.
void tell_unmet(const Output& output, Problem problem, const Observer& observer) {
  problem.severity = output.unmet_is_error ? Severity::Error : Severity::Warning;
  if (output.unmet_is_error) throw BakeError(std::move(problem));
  report(observer, problem);
}

bool keeps_positions(const Output& output, const OutputReport& written) {
  return written.max_error <= output.max_error;
}

bool keeps_normals(const Output& output, const NormalReport& normals) {
  const NormalBounds& bounds = output.max_normal_error;
  return normals.maximum <= bounds.maximum.value_or(180) &&
         normals.percentile_99 <= bounds.percentile_99.value_or(180);
}

const char* hint_for(const Output& output) {
  const bool is_float = output.encoding == Encoding::Float || output.encoding == Encoding::Sparse;
  return is_float
             ? "\"targets\": \"frames\" is as exact as float32; a larger bound, or \"unmet\": "
               "\"warning\", accepts it"
             : "\"encoding\": \"sparse\" writes floats, which are finer than integers; a larger "
               "bound, or \"unmet\": \"warning\", accepts it";
}

void check_positions(const Recipe& recipe, std::size_t index, const OutputReport& written,
                     const Observer& observer) {
  const Output& output = recipe.outputs[index];
  if (keeps_positions(output, written)) return;
  Problem problem{
      Severity::Error, "export.position-error",
      location_in(recipe, fmt::format("/outputs/{}/max_error", index)),
      fmt::format("positions are up to {:.3g} of the diagonal off, more than the {:.3g} "
                  "that are allowed; worst at vertex {} and {:.4g} s",
                  written.max_error, output.max_error, written.worst_vertex, written.worst_time),
      hint_for(output)};
  tell_unmet(output, std::move(problem), observer);
}

void check_normals(const Recipe& recipe, std::size_t index, const NormalReport& normals,
                   const Observer& observer) {
  const Output& output = recipe.outputs[index];
  if (keeps_normals(output, normals)) return;
  const NormalBounds& bounds = output.max_normal_error;
  const bool is_whole = normals.maximum <= bounds.maximum.value_or(180);
  const double bound = is_whole ? *bounds.percentile_99 : *bounds.maximum;
  Problem problem{
      Severity::Error, "export.normal-error",
      location_in(recipe, fmt::format("/outputs/{}/max_normal_error", index)),
      fmt::format(
          "normals are up to {:.2f} degrees off ({:.2f} for 99 in 100), more than the {:.4g} "
          "that are allowed; worst at vertex {} and {:.4g} s",
          normals.maximum, normals.percentile_99, bound, normals.vertex, normals.time),
      "\"targets\": \"frames\" follows normals closer than \"tracks\"; a larger bound, or "
      "\"unmet\": \"warning\", accepts it"};
  tell_unmet(output, std::move(problem), observer);
}

}  // namespace

bool keeps_bounds(const Output& output, const OutputReport& written) {
  return keeps_positions(output, written) && keeps_normals(output, written.normals);
}

void check_bounds(const Recipe& recipe, std::size_t index, const OutputReport& written,
                  const Observer& observer) {
  check_positions(recipe, index, written, observer);
  check_normals(recipe, index, written.normals, observer);
}

}  // namespace morphbake
