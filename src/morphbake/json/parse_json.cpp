#include <fmt/core.h>

#include <algorithm>
#include <unordered_set>
#include <utility>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

constexpr std::size_t depth_limit = 64;
constexpr std::size_t duplicates_limit = 100;

struct SyntaxError {
  std::size_t offset = 0;  ///< of the offending byte
  std::string message;
};

/// An array or object that is not closed yet.
struct OpenContainer {
  Json* value = nullptr;
  std::string key;  ///< the field that is being read
  std::unordered_set<std::string> keys;
};

/// Builds a document from the parser's events; unlike nlohmann's own builder it refuses repeated
/// fields and deep nesting, and adds fields in constant time.
class DocumentBuilder : public nlohmann::json_sax<Json> {
 public:
  explicit DocumentBuilder(const JsonLimits& limits) : limits_(limits) {}

  bool null() override { return add(nullptr); }

  bool boolean(bool value) override { return add(value); }

  bool number_integer(number_integer_t value) override { return add(value); }

  bool number_unsigned(number_unsigned_t value) override { return add(value); }

  bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }

  bool string(string_t& value) override {
    too_long = value.size() > limits_.string_bytes;
    return !too_long && add(std::move(value));
  }

  bool binary(binary_t& /*value*/) override { return false; }

  bool start_object(std::size_t /*size*/) override { return open(Json::object()); }

  bool start_array(std::size_t /*size*/) override { return open(Json::array()); }

  bool end_object() override { return close(); }

  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    too_long = name.size() > limits_.string_bytes;
    if (too_long) return false;
    OpenContainer& object = open_.back();
    object.key = name;
    if (object.keys.insert(name).second) return true;
    duplicates.push_back(child_pointer(pointer(), name));
    return duplicates.size() < duplicates_limit;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) override {
    syntax_error = {position > 0 ? position - 1 : 0, error.what()};
    return false;
  }

  Json document;
  bool too_deep = false;
  bool too_long = false;
  bool too_many = false;
  SyntaxError syntax_error;
  std::vector<std::string> duplicates;  ///< pointers

 private:
  Json* place(Json value) {
    if (open_.empty()) {
      document = std::move(value);
      return &document;
    }
    Json& parent = *open_.back().value;
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    // The base class's append: operator[] of an ordered map searches all fields.
    auto& fields = static_cast<Json::object_t::Container&>(parent.get_ref<Json::object_t&>());
    fields.emplace_back(open_.back().key, std::move(value));
    return &fields.back().second;
  }

  bool has_room() {
    too_many = ++count_ > limits_.values;
    return !too_many;
  }

  bool add(Json value) {
    if (!has_room()) return false;
    place(std::move(value));
    return true;
  }

  bool open(Json container) {
    too_deep = open_.size() >= depth_limit;
    if (too_deep || !has_room()) return false;
    Json* value = place(std::move(container));
    open_.push_back({value, {}, {}});
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::string pointer() const {
    std::string text;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
      const OpenContainer& container = open_[i];
      text = container.value->is_array() ? child_pointer(text, container.value->size() - 1)
                                         : child_pointer(text, container.key);
    }
    return text;
  }

  JsonLimits limits_;
  std::size_t count_ = 0;
  std::vector<OpenContainer> open_;
};

/// What a document may not have although it is JSON.
void refuse_excess(const DocumentBuilder& builder, const JsonLimits& limits,
                   const std::string& file) {
  if (builder.too_many) {
    throw BakeError(Problem{Severity::Error,
                            "json.too-many-values",
                            {file, ""},
                            fmt::format("the JSON has more than {} values", limits.values),
                            ""});
  }
  if (builder.too_deep) {
    throw BakeError(Problem{Severity::Error,
                            "json.too-deep",
                            {file, ""},
                            fmt::format("brackets are nested more than {} deep", depth_limit),
                            ""});
  }
  if (builder.too_long) {
    throw BakeError(
        Problem{Severity::Error,
                "json.too-long",
                {file, ""},
                fmt::format("a name or string is longer than {} bytes", limits.string_bytes),
                ""});
  }
}

/// nlohmann's message without its number, its own line and column and its quotation of what was
/// read, which may be megabytes or no UTF-8.
std::string plain_message(const std::string& what) {
  std::string text = what.substr(std::min(what.find("] ") + 2, what.size()));
  const std::size_t column = text.find(", column ");
  if (text.starts_with("parse error") && column != std::string::npos) {
    text = text.substr(std::min(text.find(": ", column) + 2, text.size()));
  }
  const std::size_t quotation = text.find("; last read: '");
  const std::size_t expectation = text.rfind("'; expected ");
  if (quotation != std::string::npos) {
    const bool expects = expectation != std::string::npos && expectation > quotation;
    text = text.substr(0, quotation) + (expects ? text.substr(expectation + 1) : "");
  }
  return text;
}

/// What people usually did when the parser stops at `offset`.
std::string syntax_hint(std::string_view text, std::size_t offset, const std::string& message) {
  if (message.find("UTF-8") != std::string::npos) return "save the file as UTF-8";
  if (message.find("overflow") != std::string::npos) return "numbers go up to 1.8e308";
  if (message.find("unexpected end of input") != std::string::npos) {
    return "a bracket that was opened is never closed";
  }
  if (message.find("unexpected string literal; expected '") != std::string::npos) {
    return "a comma may be missing before it";
  }
  if (offset >= text.size()) return "";
  std::size_t word = offset;
  while (word > 0 && std::isalpha(static_cast<unsigned char>(text[word - 1])) != 0) --word;
  const std::string_view rest = text.substr(word);
  if (rest.starts_with("NaN") || rest.starts_with("nan") || rest.starts_with("Inf")) {
    return "JSON knows no NaN or Infinity; leave a field out to have its default";
  }
  if (rest.starts_with("True") || rest.starts_with("False")) return "write true or false";
  if (text[offset] == '/' || text[offset] == '#') return "JSON has no comments";
  if (text[offset] == '\'') return "strings stand in double quotes";
  if (text[offset] == '}' || text[offset] == ']') {
    const std::size_t before =
        offset == 0 ? std::string_view::npos : text.find_last_not_of(" \t\r\n", offset - 1);
    if (before != std::string_view::npos && text[before] == ',') {
      return "remove the comma before it";
    }
  }
  return "";
}

Problem syntax_problem(std::string_view text, const SyntaxError& error, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return {Severity::Error, "json.syntax", {file, "", 1, 1}, "the file is empty", ""};
  }
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    return {Severity::Error,
            "json.syntax",
            {file, "", 1, 1},
            "the file is UTF-16, not UTF-8",
            "save the file as UTF-8"};
  }
  const std::string_view before = text.substr(0, std::min(error.offset, text.size()));
  const auto line = std::ranges::count(before, '\n') + 1;
  const std::string_view on_line = before.substr(before.rfind('\n') + 1);
  const auto column = 1 + std::ranges::count_if(on_line, [](char byte) {
                        return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
                      });
  const std::string message = plain_message(error.message);
  return {Severity::Error,
          "json.syntax",
          {file, "", static_cast<int>(line), static_cast<int>(column)},
          message,
          syntax_hint(text, error.offset, message)};
}

}  // namespace

Json parse_json(std::string_view text, const std::string& file, const JsonLimits& limits) {
  DocumentBuilder builder(limits);
  const bool parsed = Json::sax_parse(text.begin(), text.end(), &builder);
  refuse_excess(builder, limits, file);
  std::vector<Problem> problems;
  for (const std::string& pointer : builder.duplicates) {
    problems.push_back({Severity::Error,
                        "json.duplicate-key",
                        {file, pointer},
                        "this field stands here twice",
                        "remove or rename one of them"});
  }
  if (!parsed && problems.size() < duplicates_limit) {
    problems.push_back(syntax_problem(text, builder.syntax_error, file));
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return std::move(builder.document);
}

}  // namespace morphbake
