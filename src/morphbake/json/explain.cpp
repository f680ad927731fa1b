#include "morphbake/json/explain.h"

#include <fmt/core.h>

#include <regex>
#include <sstream>
#include <utility>

#include "morphbake/json/nearest.h"
#include "morphbake/json/wording.h"

namespace morphbake {
namespace {

/// A value of the document beside the part of the schema that describes it.
struct Place {
  const Json& value;
  SchemaField field;
  std::string pointer;
  std::string name;    ///< what messages call it: "fps", "tracks[0]", "\"tail\""
  std::string prefix;  ///< of codes
};

struct Walk {
  const Json& schema;
  std::string file;
  std::vector<Problem> problems;
};

void complain(Walk& walk, const Place& at, const char* code, std::string message,
              std::string hint) {
  walk.problems.push_back({Severity::Error,
                           at.prefix + code,
                           {walk.file, at.pointer},
                           std::move(message),
                           std::move(hint)});
}

void complain_not_wanted(Walk& walk, const Place& at, const char* code) {
  complain(walk, at, code,
           fmt::format("{} must be {}, not {}", at.name, wanted(at.field), shown(at.value)),
           described(at.field));
}

SchemaField field_of(const Walk& walk, const Json& node) {
  return {node, referred(walk.schema, node)};
}

bool has_type(const Json& value, const std::string& type) {
  if (type == "string") return value.is_string();
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "boolean") return value.is_boolean();
  if (type == "number") return value.is_number();
  if (type == "null") return value.is_null();
  if (type != "integer" || !value.is_number()) return false;
  return value.is_number_integer() || value.get<double>() == std::floor(value.get<double>());
}

bool has_type(const Json& value, const Json& type) {
  if (type.is_null()) return true;
  if (type.is_string()) return has_type(value, type.get<std::string>());
  for (const Json& each : type) {
    if (has_type(value, each.get<std::string>())) return true;
  }
  return false;
}

void check_number(Walk& walk, const Place& at) {
  const double value = at.value.get<double>();
  const Json& target = at.field.target;
  const bool small = target.contains("minimum") && value < target["minimum"].get<double>();
  const bool large = target.contains("maximum") && value > target["maximum"].get<double>();
  const bool not_above =
      target.contains("exclusiveMinimum") && value <= target["exclusiveMinimum"].get<double>();
  if (small || large || not_above) complain_not_wanted(walk, at, ".out-of-range");
}

bool fits_as_string(const std::string& text, const Json& target) {
  const auto letters =
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; });
  if (letters < target.value("minLength", 0)) return false;
  if (letters > target.value("maxLength", std::numeric_limits<int>::max())) return false;
  const auto pattern = target.find("pattern");
  return pattern == target.end() ||
         std::regex_search(text, std::regex(pattern->get<std::string>()));
}

/// Adds the name that may have been meant.
void suggest(Walk& walk, const Json& value, const std::vector<std::string>& names) {
  const std::string nearest =
      value.is_string() ? nearest_name(value.get<std::string>(), names) : "";
  if (!nearest.empty()) {
    walk.problems.back().hint = fmt::format("did you mean \"{}\"?", nearest);
  }
}

/// The words of a pattern "^(one|two)$", which stands for an enum where a list may stand as well.
std::vector<std::string> words_of(const Json& target) {
  std::vector<std::string> words;
  const auto pattern = target.value("pattern", std::string());
  if (!pattern.starts_with("^(") || !pattern.ends_with(")$")) return words;
  std::istringstream alternatives(pattern.substr(2, pattern.size() - 4));
  for (std::string word; std::getline(alternatives, word, '|');) words.push_back(word);
  return words;
}

/// const and enum; true when the value is one of those.
bool check_choice(Walk& walk, const Place& at) {
  const Json& target = at.field.target;
  const auto constant = target.find("const");
  if (constant != target.end() && *constant != at.value) {
    complain_not_wanted(walk, at, ".bad-value");
    return false;
  }
  const auto choices = target.find("enum");
  if (choices == target.end()) return true;
  std::vector<std::string> names;
  for (const Json& choice : *choices) {
    if (choice == at.value) return true;
    if (choice.is_string()) names.push_back(choice.get<std::string>());
  }
  complain_not_wanted(walk, at, at.value.is_string() ? ".bad-value" : ".wrong-type");
  suggest(walk, at.value, names);
  return false;
}

void check(Walk& walk, const Place& at);

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

/// Complains about too few or too many entries.
///
/// @return  whether they are worth a look each: not when they are too many
bool check_count(Walk& walk, const Place& at, const char* least_keyword, const char* most_keyword) {
  const Json& target = at.field.target;
  const Json least = target.value(least_keyword, Json());
  const Json most = target.value(most_keyword, Json());
  const std::size_t count = at.value.size();
  const bool few = !least.is_null() && count < least.get<std::size_t>();
  const bool many = !most.is_null() && count > most.get<std::size_t>();
  if (!few && !many) return true;
  const bool has_fields = at.value.is_object() && target.contains("properties");
  const std::string has = at.value.is_object() && count > 0
                              ? fmt::format("{} ({})", count, name_list(keys_of(at.value)))
                              : fmt::format("{}", count);
  complain(walk, at, ".bad-value",
           fmt::format("{} must have {}, not {}", at.name,
                       wanted_count(least, most, has_fields ? "field" : "entry"), has),
           has_fields ? "its fields are: " + name_list(keys_of(target["properties"]))
                      : described(at.field));
  return !many;
}

void check_array(Walk& walk, const Place& at) {
  if (!check_count(walk, at, "minItems", "maxItems")) return;
  const Json& target = at.field.target;
  const Json any = Json::object();
  for (std::size_t i = 0; i < at.value.size() && walk.problems.size() < problems_limit; ++i) {
    const Json& entry = at.value[i];
    const Place below{entry, field_of(walk, target.contains("items") ? target["items"] : any),
                      child_pointer(at.pointer, i), fmt::format("{}[{}]", at.name, i), at.prefix};
    check(walk, below);
  }
}

void check_required(Walk& walk, const Place& at) {
  const Json& target = at.field.target;
  if (!target.contains("required")) return;
  for (const Json& each : target["required"]) {
    const auto name = each.get<std::string>();
    if (at.value.contains(name)) continue;
    const SchemaField field = field_of(walk, target["properties"][name]);
    const Json& examples = field["examples"];
    const std::string example =
        examples.is_null() ? "" : fmt::format("add \"{}\": {}. ", name, examples[0].dump());
    const Json& description = field["description"];
    complain(walk, at, ".missing-field", fmt::format("field \"{}\" is missing", name),
             example + (description.is_null() ? "" : description.get<std::string>()));
  }
}

/// A field whose name stands in no schema, or any entry of a map.
void check_additional(Walk& walk, const Place& at, const std::string& key, const Json& value) {
  const Json& target = at.field.target;
  const std::string pointer = child_pointer(at.pointer, key);
  const std::string name = shown(Json(key));
  const auto additional = target.find("additionalProperties");
  if (additional == target.end() || *additional == true) return;
  if (additional->is_object()) {
    check(walk, {value, field_of(walk, *additional), pointer, name, at.prefix});
    return;
  }
  std::vector<std::string> known;
  for (const auto& [field, node] : target["properties"].items()) {
    if (field != "$schema") known.push_back(field);
  }
  complain(walk, {value, at.field, pointer, name, at.prefix}, ".unknown-field",
           fmt::format("unknown field {}", name), name_hint(key, known, "the fields here"));
}

void check_object(Walk& walk, const Place& at) {
  const Json& target = at.field.target;
  // A few fields too many are looked at: the one that is no field is told by name.
  const bool has_fields = at.field.target.contains("properties");
  if (!check_count(walk, at, "minProperties", "maxProperties") && !has_fields) return;
  check_required(walk, at);
  const Json none = Json::object();
  const Json& properties = target.contains("properties") ? target["properties"] : none;
  for (const auto& [key, value] : at.value.items()) {
    if (walk.problems.size() >= problems_limit) return;
    const std::string pointer = child_pointer(at.pointer, key);
    if (target.contains("propertyNames")) {
      const SchemaField names = field_of(walk, target["propertyNames"]);
      const Json name(key);
      if (!fits_as_string(key, names.target)) {
        complain(walk, {name, names, pointer, key, at.prefix}, ".bad-value",
                 fmt::format("{} is not {}", shown(name), wanted(names)), described(names));
      }
    }
    const auto property = properties.find(key);
    if (property == properties.end()) {
      check_additional(walk, at, key, value);
    } else {
      check(walk, {value, field_of(walk, *property), pointer, key, at.prefix});
    }
  }
}

void check(Walk& walk, const Place& place) {
  if (!place.field.target.is_object()) return;  // true, or false, which valijson reports
  Place at = place;
  at.prefix = at.field.target.value("x-problems", at.prefix);
  const Json& target = at.field.target;
  if (!has_type(at.value, target.value("type", Json()))) {
    complain_not_wanted(walk, at, ".wrong-type");
    return;
  }
  if (!check_choice(walk, at)) return;
  if (at.value.is_number()) check_number(walk, at);
  if (at.value.is_string() && !fits_as_string(at.value.get<std::string>(), target)) {
    complain_not_wanted(walk, at, ".bad-value");
    suggest(walk, at.value, words_of(target));
  }
  if (at.value.is_array()) check_array(walk, at);
  if (at.value.is_object()) check_object(walk, at);
}

}  // namespace

const Json& referred(const Json& schema, const Json& node) {
  const Json* target = &node;
  while (target->is_object() && target->contains("$ref")) {
    const auto reference = (*target)["$ref"].get<std::string>();
    target = &schema.at(Json::json_pointer(reference.substr(1)));
  }
  return *target;
}

std::vector<Problem> explain(const Json& document, const Json& schema, const Location& place) {
  Walk walk{schema, place.file, {}};
  check(walk, {document, field_of(walk, schema), place.pointer, "the document", ""});
  return std::move(walk.problems);
}

}  // namespace morphbake
