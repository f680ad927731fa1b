#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace morphbake {

/// A JSON document that keeps the order of its fields: recipes are ordered (sources, tracks).
using Json = nlohmann::ordered_json;

/// How large a document may be.
struct JsonLimits {
  // std::regex, which checks names and paths, recurses once a letter: 8192 overflow the stack under
  // AddressSanitizer.
  std::size_t string_bytes = 1024;            ///< of one name or string
  std::size_t values = std::size_t{1} << 22;  ///< numbers, strings, arrays, objects, ...
};

/// Parses UTF-8 JSON text; a UTF-8 byte order mark is skipped.
///
/// @param file  what messages call the text
/// @throws BakeError "json.syntax" with line and column, "json.too-deep" beyond 64 brackets,
///         "json.too-long" for a string beyond its limit, "json.too-many-values",
///         "json.duplicate-key" for all repeated fields
Json parse_json(std::string_view text, const std::string& file, const JsonLimits& limits = {});

/// Reads and parses a file of at most 16 MB.
///
/// @param name  what messages call the file
/// @throws BakeError as parse_json and read_file
Json read_json(const std::filesystem::path& file, const std::string& name);

/// The JSON pointer of a field (RFC 6901): "~" and "/" in `key` are escaped.
std::string child_pointer(const std::string& pointer, std::string_view key);

/// The JSON pointer of an array's entry.
std::string child_pointer(const std::string& pointer, std::size_t index);

/// `value` as one short line for a message: control characters escaped, long values cut.
std::string shown(const Json& value);

}  // namespace morphbake
