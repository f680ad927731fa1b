#include "morphbake/json/schema.h"

#include <fmt/core.h>

#include <set>
#include <stdexcept>
#include <utility>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "morphbake/json/embedded.h"
#include "morphbake/json/explain.h"

namespace morphbake {
namespace {

using valijson::adapters::NlohmannJsonAdapter;

Json embedded_schema(std::string_view name) {
  for (const EmbeddedFile& file : embedded_schemas()) {
    if (file.name == name) return parse_json(file.text, std::string(name));
  }
  throw std::logic_error(fmt::format("no schema {}", name));
}

/// The part of another schema that `reference` names: "options.schema.json#/definitions/x".
Json foreign_part(const std::string& reference) {
  const std::size_t hash = std::min(reference.find('#'), reference.size());
  Json part = embedded_schema(reference.substr(0, hash));
  if (hash < reference.size()) part = part.at(Json::json_pointer(reference.substr(hash + 1)));
  part.erase("$schema");
  return part;
}

void put_in_foreign_parts(Json& node) {
  if (!node.is_structured()) return;
  const auto reference = node.is_object() ? node.find("$ref") : node.end();
  if (reference != node.end() && reference->is_string() &&
      !reference->get_ref<const std::string&>().starts_with('#')) {
    Json part = foreign_part(reference->get<std::string>());
    node.erase("$ref");
    part.update(node);  // the description and default that stand beside "$ref"
    node = std::move(part);
  }
  for (Json& child : node) put_in_foreign_parts(child);
}

/// As draft-07 has it, 3.0 is an integer; valijson only takes numbers without a point.
void write_whole_numbers_as_integers(nlohmann::json& value) {
  constexpr double exact = 9007199254740992.0;  // 2^53
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (std::abs(number) < exact && number == std::floor(number)) {
      value = static_cast<std::int64_t>(number);
    }
  } else if (value.is_structured()) {
    for (nlohmann::json& child : value) write_whole_numbers_as_integers(child);
  }
}

/// "/timeline/tracks/0" from "<root>", "[timeline]", "[tracks]", "[0]".
std::string pointer_of(const std::vector<std::string>& context, std::string pointer) {
  for (const std::string& step : context) {
    if (step.size() < 2 || step.front() != '[') continue;
    pointer = child_pointer(pointer, step.substr(1, step.size() - 2));
  }
  return pointer;
}

bool stands_below(const std::set<std::string>& pointers, const std::string& pointer) {
  if (pointers.contains(pointer)) return true;
  const auto next = pointers.lower_bound(pointer + "/");
  return next != pointers.end() && next->starts_with(pointer + "/");
}

/// Problems of valijson's that `explained` has no words for, innermost first.
void add_unexplained(std::vector<Problem>& explained, const valijson::ValidationResults& results,
                     const std::string& prefix, const Location& place) {
  std::set<std::string> pointers;
  for (const Problem& problem : explained) pointers.insert(problem.location.pointer);
  for (const auto& error : results) {
    const std::string pointer = pointer_of(error.context, place.pointer);
    if (stands_below(pointers, pointer)) continue;
    pointers.insert(pointer);
    explained.push_back({Severity::Error,
                         prefix + ".bad-value",
                         {place.file, pointer},
                         "this does not fit its schema: " + error.description,
                         ""});
  }
  if (!explained.empty()) return;
  explained.push_back(
      {Severity::Error, prefix + ".bad-value", place, "this does not fit its schema", ""});
}

}  // namespace

Json shipped_schema(std::string_view name) {
  Json schema = embedded_schema(name);
  put_in_foreign_parts(schema);
  return schema;
}

std::vector<Problem> schema_problems(const Json& document, const Json& schema,
                                     const Location& place) {
  std::vector<Problem> problems = explain(document, schema, place);
  // Enough to do, and valijson keeps a list of strings for each.
  if (problems.size() >= problems_limit) return problems;
  const nlohmann::json plain_schema = schema;
  nlohmann::json plain_document = document;
  write_whole_numbers_as_integers(plain_document);
  valijson::Schema compiled;
  valijson::SchemaParser parser;
  parser.populateSchema(NlohmannJsonAdapter(plain_schema), compiled);
  valijson::Validator validator;
  valijson::ValidationResults results;
  const NlohmannJsonAdapter target(plain_document);
  if (validator.validate(compiled, target, &results)) return {};
  add_unexplained(problems, results, schema.value("x-problems", "json"), place);
  return problems;
}

}  // namespace morphbake
