#include "morphbake/bake/options.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "morphbake/json/nearest.h"
#include "morphbake/json/schema.h"

namespace morphbake {

// How the choices are written in files; found by nlohmann's conversions through their names.
NLOHMANN_JSON_SERIALIZE_ENUM(Solver,
                             {{Solver::Auto, name_of(Solver::Auto)},
                              {Solver::Direct, name_of(Solver::Direct)},
                              {Solver::Warm, name_of(Solver::Warm)},
                              {Solver::ConjugateGradients, name_of(Solver::ConjugateGradients)},
                              {Solver::GaussSeidel, name_of(Solver::GaussSeidel)},
                              {Solver::Jacobi, name_of(Solver::Jacobi)}})
NLOHMANN_JSON_SERIALIZE_ENUM(RightHandSide,
                             {{RightHandSide::Edge, "edge"}, {RightHandSide::Vertex, "vertex"}})

namespace {

/// One option of a stage: its name in files, and where its value is kept.
template <typename Stage>
struct Field {
  const char* name;
  std::variant<int Stage::*, double Stage::*, bool Stage::*, std::array<double, 3> Stage::*,
               Solver Stage::*, RightHandSide Stage::*>
      member;
};

constexpr Field<SolveOptions> solve_fields[] = {
    {"solver", &SolveOptions::solver},
    {"right_hand_side", &SolveOptions::right_hand_side},
    {"tolerance", &SolveOptions::tolerance},
    {"max_iterations", &SolveOptions::max_iterations},
    {"memory_limit", &SolveOptions::memory_limit},
    {"every_frame", &SolveOptions::every_frame},
};

constexpr Field<BasisOptions> basis_fields[] = {
    {"easing_tolerance", &BasisOptions::easing_tolerance},
};

// Size and number of pictures stand in a recipe's "preview", threads on the command line.
constexpr Field<TurntableOptions> turntable_fields[] = {
    {"samples", &TurntableOptions::samples},
    {"orbit", &TurntableOptions::orbit},
    {"azimuth", &TurntableOptions::azimuth},
    {"elevation", &TurntableOptions::elevation},
    {"field_of_view", &TurntableOptions::field_of_view},
    {"fill", &TurntableOptions::fill},
    {"floor_follows", &TurntableOptions::floor_follows},
    {"background", &TurntableOptions::background},
};

/// Calls `each(stage's name, stage's options, stage's fields)` for every stage: the one list of
/// them.
template <typename Options, typename Function>
void for_each_stage(Options& options, const Function& each) {
  each("solve", options.solve, solve_fields);
  each("basis", options.basis, basis_fields);
  each("turntable", options.turntable, turntable_fields);
}

Json to_json(const BakeOptions& options) {
  Json json;
  for_each_stage(options, [&](const char* stage, const auto& values, const auto& fields) {
    for (const auto& field : fields) {
      std::visit([&](auto member) { json[stage][field.name] = values.*member; }, field.member);
    }
  });
  return json;
}

/// @param json  valid by schemas/options.schema.json
void assign(BakeOptions& options, const Json& json) {
  for_each_stage(options, [&](const char* stage, auto& values, const auto& fields) {
    const Json given = json.value(stage, Json::object());
    for (const auto& field : fields) {
      if (!given.contains(field.name)) continue;
      std::visit([&](auto member) { given[field.name].get_to(values.*member); }, field.member);
    }
  });
}

/// "/basis", "/basis/easing_tolerance", ...
std::vector<std::string> known_pointers() {
  std::vector<std::string> pointers;
  const Json defaults = to_json({});
  for (const auto& [stage, fields] : defaults.items()) {
    for (const auto& [field, value] : fields.items()) {
      pointers.push_back(fmt::format("/{}/{}", stage, field));
    }
  }
  return pointers;
}

Problem bad_setting(const std::string& code, const std::string& pointer, std::string message,
                    std::string hint) {
  return {Severity::Error, code, {"--set", pointer}, std::move(message), std::move(hint)};
}

/// The document that "/basis/easing_tolerance=1e-7" stands for; a problem instead when it stands
/// for none.
Json document_of(const std::string& setting, std::vector<Problem>& problems) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) {
    problems.push_back(bad_setting("options.bad-setting", "",
                                   fmt::format("{} sets nothing", shown(Json(setting))),
                                   "write for example --set /basis/easing_tolerance=1e-7"));
    return {};
  }
  const std::string pointer = setting.substr(0, equals);
  const std::vector<std::string> known = known_pointers();
  if (std::find(known.begin(), known.end(), pointer) == known.end()) {
    problems.push_back(bad_setting("options.unknown-field", "",
                                   fmt::format("there is no option {}", shown(Json(pointer))),
                                   name_hint(pointer, known, "options")));
    return {};
  }
  const std::string text = setting.substr(equals + 1);
  Json value = text;
  try {
    value = parse_json(text, "--set");
  } catch (const BakeError&) {
    // What is no JSON is a string; the schema says whether the option takes one.
  }
  Json document;
  document[Json::json_pointer(pointer)] = std::move(value);
  return document;
}

void append(std::vector<Problem>& problems, std::vector<Problem> more) {
  problems.insert(problems.end(), std::make_move_iterator(more.begin()),
                  std::make_move_iterator(more.end()));
}

}  // namespace

std::string options_to_json(const BakeOptions& options) { return to_json(options).dump(2) + "\n"; }

BakeOptions read_options(const std::string& recipe_options, const std::string& recipe_file,
                         const std::vector<std::string>& settings) {
  const Json schema = shipped_schema("options.schema.json");
  std::vector<Json> layers = {parse_json(recipe_options, recipe_file)};
  std::vector<Problem> problems =
      schema_problems(layers.front(), schema, {recipe_file, "/options"});
  for (const std::string& setting : settings) {
    Json layer = document_of(setting, problems);
    if (layer.is_null()) continue;
    append(problems, schema_problems(layer, schema, {"--set", ""}));
    layers.push_back(std::move(layer));
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  BakeOptions options;
  for (const Json& layer : layers) assign(options, layer);
  return options;
}

}  // namespace morphbake
