#include "morphbake/gltf/names.h"

#include <fmt/core.h>

#include <algorithm>

#include "morphbake/json/nearest.h"

namespace morphbake {
namespace {

std::string index_hint(const std::string& kind, std::size_t count) {
  return count == 0 ? fmt::format("the file has no {}", kind)
                    : fmt::format("indices go from 0 to {}", count - 1);
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): where it is looked for, and how that is called
int index_of_choice(const GltfDocument& document, const NameOrIndex& choice,
                    const std::vector<std::string>& names, const std::string& kind,
                    const std::string& pointer) {
  const std::string code = "gltf.no-such-" + kind;
  if (const int* index = std::get_if<int>(&choice)) {
    if (*index >= 0 && static_cast<std::size_t>(*index) < names.size()) return *index;
    fail_at(document, pointer, code, fmt::format("there is no {} {}", kind, *index),
            index_hint(kind, names.size()));
  }
  const auto& name = std::get<std::string>(choice);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    fail_at(document, pointer, code, fmt::format("there is no {} {}", kind, shown(Json(name))),
            names.empty() ? index_hint(kind, 0) : name_hint(name, names, kind + "s"));
  }
  if (std::find(found + 1, names.end(), name) != names.end()) {
    fail_at(document, pointer, code,
            fmt::format("more than one {} is called {}", kind, shown(Json(name))),
            fmt::format("choose one by its index; the first is {}", found - names.begin()));
  }
  return static_cast<int>(found - names.begin());
}

}  // namespace morphbake
