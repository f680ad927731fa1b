#pragma once

#include <span>
#include <string_view>

namespace morphbake {

struct EmbeddedFile {
  std::string_view name;  ///< "recipe.schema.json"
  std::string_view text;
};

/// The files of schemas/, compiled into the library (cmake/morphbake-embed.cmake).
std::span<const EmbeddedFile> embedded_schemas();

/// The files of config/profiles, likewise.
std::span<const EmbeddedFile> embedded_profiles();

}  // namespace morphbake
