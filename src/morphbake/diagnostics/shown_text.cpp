#include "morphbake/diagnostics/shown_text.h"

#include <fmt/core.h>

namespace morphbake {

std::string without_control_characters(const std::string& text) {
  std::string shown;
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte < 0x20 || byte == 0x7F) {
      shown += fmt::format("\\u{:04x}", byte);
    } else {
      shown += letter;
    }
  }
  return shown;
}

}  // namespace morphbake
