#include <fmt/core.h>

#include "cli/commands.h"

namespace morphbake::cli {
namespace {

/// Why a text is no number from 0 to `most`, or "".
CLI::Validator number_up_to(double most) {
  const auto check = [most](const std::string& text) -> std::string {
    double number = 0;
    const bool is_number =
        CLI::detail::lexical_cast(text, number) && number >= 0 && number <= most;  // not NaN
    return is_number ? "" : fmt::format("'{}' is no number from 0 to {}", text, most);
  };
  return CLI::Validator(check, "", "number");
}

}  // namespace

void add_tolerances(CLI::App& parser, DiffOptions& options) {
  parser
      .add_option("--tolerance", options.absolute,
                  "How far a vertex may be away, in units of the scene (metres)")
      ->check(number_up_to(1e30));
  parser
      .add_option("--relative", options.relative,
                  "The same as a fraction of the bounding-box diagonal of the first frame of the "
                  "first file; of both the larger holds (default: 1e-5, without --tolerance)")
      ->check(number_up_to(1e30));
  parser
      .add_option("--normals", options.normal_angle,
                  "Degrees that a normal may be turned by (default: 0.1 where both files have the "
                  "same weights; else normals are told, not judged)")
      ->check(number_up_to(180));
  parser
      .add_option("--attributes", options.attribute,
                  "How far other numbers may be apart: colours, texture coordinates, skins, "
                  "materials")
      ->check(number_up_to(1e30))
      ->capture_default_str();
  parser.add_flag("--strict", options.strict,
                  "Names and weights of targets, the order of triangles, normals in any case, and "
                  "times between the frames of a sampled motion count as well");
  parser
      .add_option("--threads", options.threads, "0: all cores; changes the time, never the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

}  // namespace morphbake::cli
