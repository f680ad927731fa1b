#pragma once

#include <string>

namespace morphbake {

/// A recipe's name in a batch, which is its folder below that of all outputs.
struct BatchName {
  std::string name;     ///< in its shortest form: "nose/recipe"
  std::string refusal;  ///< why it can be none, or ""
};

/// The name that a text stands for: relative, below the folder, and no file that a batch writes.
BatchName batch_name(const std::string& text);

}  // namespace morphbake
