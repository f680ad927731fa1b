#include "morphbake/json/wording.h"

#include <fmt/core.h>

namespace morphbake {
namespace {

const Json nothing;  // null, for keywords that are not there

std::string type_in_words(const std::string& type) {
  if (type == "integer") return "a whole number";
  if (type == "object") return "an object, written {...}";
  if (type == "array") return "a list, written [...]";
  if (type == "boolean") return "true or false";
  return "a " + type;
}

std::string types_in_words(const Json& type) {
  if (type.is_string()) return type_in_words(type.get<std::string>());
  std::string words;
  for (const Json& each : type) {
    words += (words.empty() ? "" : " or ") + type_in_words(each.get<std::string>());
  }
  return words.empty() ? "something else" : words;
}

std::string number(const Json& value) { return fmt::format("{}", value.get<double>()); }

std::string range_in_words(const SchemaField& field) {
  const Json& least = field["minimum"];
  const Json& most = field["maximum"];
  const Json& above = field["exclusiveMinimum"];
  if (!above.is_null() && !most.is_null()) {
    return fmt::format(" above {} and up to {}", number(above), number(most));
  }
  if (!above.is_null()) return fmt::format(" above {}", number(above));
  if (!least.is_null() && !most.is_null()) {
    return fmt::format(" from {} to {}", number(least), number(most));
  }
  if (!least.is_null()) return fmt::format(" of at least {}", number(least));
  if (!most.is_null()) return fmt::format(" of at most {}", number(most));
  return "";
}

std::string choices(const Json& values) {
  std::string words;
  for (const Json& value : values) words += (words.empty() ? "" : ", ") + value.dump();
  return words;
}

}  // namespace

const Json& SchemaField::operator[](const char* keyword) const {
  const auto own = node.find(keyword);
  if (own != node.end()) return *own;
  const auto referred = target.find(keyword);
  return referred != target.end() ? *referred : nothing;
}

std::string wanted(const SchemaField& field) {
  if (!field["const"].is_null()) return field["const"].dump();
  if (!field["enum"].is_null()) return "one of " + choices(field["enum"]);
  if (!field["x-form"].is_null()) return field["x-form"].get<std::string>();
  std::string words = types_in_words(field["type"]) + range_in_words(field);
  const Json& unit = field["x-unit"];
  if (!unit.is_null()) words += fmt::format(" ({})", unit.get<std::string>());
  return words;
}

std::string counted(std::size_t count, const std::string& noun) {
  if (count == 1) return "1 " + noun;
  return fmt::format("{} {}", count, noun == "entry" ? "entries" : noun + "s");
}

std::string wanted_count(const Json& least, const Json& most, const std::string& noun) {
  if (least == most) return "exactly " + counted(least.get<std::size_t>(), noun);
  if (most.is_null()) return "at least " + counted(least.get<std::size_t>(), noun);
  if (least.is_null()) return "at most " + counted(most.get<std::size_t>(), noun);
  return fmt::format("{} to {}", least.get<std::size_t>(), counted(most.get<std::size_t>(), noun));
}

std::string described(const SchemaField& field) {
  const Json& description = field["description"];
  std::string words = description.is_null() ? "" : description.get<std::string>();
  const Json& examples = field["examples"];
  if (examples.is_null()) return words;
  return fmt::format("{} For example: {}", words, examples[0].dump());
}

}  // namespace morphbake
