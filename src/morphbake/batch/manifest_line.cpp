#include "morphbake/batch/manifest_line.h"

#include <fmt/core.h>

#include <algorithm>

#include "morphbake/json/json.h"
#include "morphbake/json/nearest.h"

namespace morphbake {
namespace {

/// A line of a report has texts that are longer than those of lists.
constexpr JsonLimits kLimits = {std::size_t{1} << 16, JsonLimits{}.values};

/// Beside these a line of a report has what came of the recipe.
const std::vector<std::string> kFields = {"recipe", "name", "set"};
constexpr const char* kHint =
    R"(write "file.json", or {"recipe": "file.json", "name": "nose", "set": {"/timeline/duration": 2}})";

[[noreturn]] void fail(const char* code, Location at, std::string pointer, std::string message,
                       std::string hint = kHint) {
  at.pointer = std::move(pointer);
  throw BakeError(Problem{Severity::Error, code, at, std::move(message), std::move(hint)});
}

Json parsed(const std::string& text, const Location& at) {
  try {
    return parse_json(text, at.file, kLimits);
  } catch (const BakeError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) problem.location.line = at.line;
    throw BakeError(std::move(problems));
  }
}

std::string text_in(const Json& json, const char* field, const Location& at) {
  const auto found = json.find(field);
  if (found == json.end()) return "";
  if (found->is_string()) return found->get<std::string>();
  fail("batch.wrong-type", at, child_pointer("", field),
       fmt::format("{} is no text", shown(*found)));
}

void check_fields(const Json& json, const Location& at) {
  if (json.contains("state")) return;  // a line of a report
  for (const auto& [field, value] : json.items()) {
    if (std::ranges::find(kFields, field) != kFields.end()) continue;
    fail("batch.unknown-field", at, child_pointer("", field),
         fmt::format("there is no field {} here", shown(Json(field))),
         name_hint(field, kFields, "fields"));
  }
}

}  // namespace

ManifestLine read_manifest_line(const std::string& text, const Location& at) {
  const Json json = parsed(text, at);
  if (json.is_string()) return {json.get<std::string>(), "", {}};
  if (!json.is_object()) {
    fail("batch.wrong-type", at, "", fmt::format("{} is no recipe", shown(json)));
  }
  check_fields(json, at);
  ManifestLine line{text_in(json, "recipe", at), text_in(json, "name", at), {}};
  if (line.recipe.empty()) fail("batch.missing-field", at, "", "the line names no recipe");
  const auto set = json.find("set");
  if (set == json.end()) return line;
  if (!set->is_object()) {
    fail("batch.wrong-type", at, "/set", fmt::format("{} is no object", shown(*set)));
  }
  for (const auto& [pointer, value] : set->items()) line.set.emplace_back(pointer, value.dump());
  return line;
}

ManifestLine read_table_line(const std::string& text, const Location& at) {
  const Json json = parsed(text, at);
  const char* hint = R"(write for example {"name": "long", "/timeline/duration": 2})";
  if (!json.is_object()) {
    fail("batch.wrong-type", at, "", fmt::format("{} is no object", shown(json)), hint);
  }
  ManifestLine line{"", text_in(json, "name", at), {}};
  for (const auto& [pointer, value] : json.items()) {
    if (pointer == "name") continue;
    if (!pointer.starts_with('/')) {
      fail("batch.bad-table", at, child_pointer("", pointer),
           fmt::format("{} is neither \"name\" nor a JSON pointer", shown(Json(pointer))), hint);
    }
    line.set.emplace_back(pointer, value.dump());
  }
  return line;
}

}  // namespace morphbake
