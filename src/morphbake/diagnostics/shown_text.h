#pragma once

#include <string>

namespace morphbake {

/// `text` with \u001b and the like for control characters: file names and fields may hold anything,
/// and a terminal must not act on it.
std::string without_control_characters(const std::string& text);

/// "12 bytes", "3.4 kB", "5.6 MB".
std::string shown_bytes(double bytes);

}  // namespace morphbake
