#include "morphbake/json/json.h"

#include "morphbake/files/files.h"

namespace morphbake {
namespace {

constexpr std::uintmax_t size_limit = 16U << 20U;
constexpr std::size_t shown_bytes = 60;

}  // namespace

Json read_json(const std::filesystem::path& file, const std::string& name) {
  return parse_json(read_file(file, size_limit), name);
}

std::string child_pointer(const std::string& pointer, std::string_view key) {
  std::string child = pointer + "/";
  for (const char letter : key) {
    if (letter == '~') {
      child += "~0";
    } else if (letter == '/') {
      child += "~1";
    } else {
      child += letter;
    }
  }
  return child;
}

std::string child_pointer(const std::string& pointer, std::size_t index) {
  return pointer + "/" + std::to_string(index);
}

std::string shown(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() <= shown_bytes) return text;
  std::size_t end = shown_bytes;
  // A UTF-8 continuation byte must not be parted from its lead byte.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

}  // namespace morphbake
