#pragma once

#include <string>

#include "morphbake/json/json.h"

namespace morphbake {

/// A field of a schema as its user and its target describe it: `node` may be {"$ref",
/// "description"}.
struct SchemaField {
  const Json& node;    ///< as it stands in its place
  const Json& target;  ///< what "$ref" names, or node itself

  /// The node's own value of a keyword, else the target's; null when neither has it.
  const Json& operator[](const char* keyword) const;
};

/// What a field wants: "a number from 1 to 1000 (frames per second)".
std::string wanted(const SchemaField& field);

/// "1 entry", "2 entries".
///
/// @param noun  "entry" or "field"
std::string counted(std::size_t count, const std::string& noun);

/// How many of `noun` it wants: "exactly 2 entries", "at least 1 entry".
///
/// @param least, most  numbers or null, not both null
std::string wanted_count(const Json& least, const Json& most, const std::string& noun);

/// The description, and an example: `How it eases; for example "linear"`.
std::string described(const SchemaField& field);

}  // namespace morphbake
