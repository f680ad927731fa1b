#include "morphbake/gltf/uri.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <optional>

namespace morphbake {
namespace {

constexpr std::string_view kScheme = "data:";
constexpr std::string_view kBase64 = ";base64";

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower;
}

/// The byte that %XX at `at` stands for, or nothing.
std::optional<unsigned char> escaped_byte(std::string_view text, std::size_t at) {
  if (text[at] != '%' || text.size() - at < 3) return std::nullopt;
  unsigned char value = 0;
  const char* digits = text.data() + at + 1;
  const auto [end, error] = std::from_chars(digits, digits + 2, value, 16);
  return error == std::errc() && end == digits + 2 ? std::optional(value) : std::nullopt;
}

void read_escaped(std::string_view text, DataUri& data) {
  data.bytes.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::optional<unsigned char> byte = escaped_byte(text, i);
    if (text[i] == '%' && !byte) {
      data.fault = fmt::format("character {} of its data is a % that no two digits follow", i);
      return;
    }
    data.bytes.push_back(byte.value_or(static_cast<unsigned char>(text[i])));
    if (byte) i += 2;
  }
}

constexpr std::uint8_t kNoDigit = 64;

constexpr std::array<std::uint8_t, 256> base64_values() {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNoDigit);
  std::uint8_t value = 0;
  for (const char c : "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/") {
    if (c != '\0') values[static_cast<unsigned char>(c)] = value++;
  }
  return values;
}

/// Digits of six bits each, made bytes in place: there are always fewer of those.
void read_base64(DataUri& data) {
  static constexpr std::array kValues = base64_values();
  std::vector<unsigned char>& bytes = data.bytes;
  std::size_t digits = bytes.size();
  while (digits > 0 && bytes.size() - digits < 2 && bytes[digits - 1] == '=') --digits;
  const bool is_padded = digits == bytes.size() || bytes.size() % 4 == 0;
  if (digits % 4 == 1 || !is_padded) {
    data.fault = fmt::format("{} digits of base64 are no whole bytes", bytes.size());
    return;
  }
  std::size_t out = 0;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    const std::uint8_t value = kValues[bytes[i]];
    if (value == kNoDigit) {
      data.fault = fmt::format("character {} of its data is no digit of base64", i);
      return;
    }
    bits = bits << 6 | value;
    if (i % 4 > 0) bytes[out++] = static_cast<unsigned char>(bits >> (6 - 2 * (i % 4)));
  }
  bytes.resize(out);
}

}  // namespace

std::string uri_path(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const std::optional<unsigned char> byte = escaped_byte(uri, i);
    text += byte ? static_cast<char>(*byte) : uri[i];
    if (byte) i += 2;
  }
  return text;
}

bool is_data_uri(std::string_view uri) {
  return in_lower_case(uri.substr(0, kScheme.size())) == kScheme;
}

DataUri read_data_uri(std::string_view uri) {
  assert(is_data_uri(uri));
  DataUri data;
  uri.remove_prefix(kScheme.size());
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) {
    data.fault = "it has no comma, after which data begins";
    return data;
  }
  const std::string head = in_lower_case(uri.substr(0, comma));
  data.media_type = head.substr(0, head.find(';'));
  read_escaped(uri.substr(comma + 1), data);
  if (data.fault.empty() && head.ends_with(kBase64)) read_base64(data);
  return data;
}

}  // namespace morphbake
