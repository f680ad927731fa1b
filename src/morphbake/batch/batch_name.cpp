#include "morphbake/batch/batch_name.h"

#include <fmt/core.h>

#include <filesystem>

#include "morphbake/json/json.h"

namespace morphbake {
namespace {

constexpr std::size_t kStepBytes = 255;  // of a name in a folder, as file systems have it
constexpr std::size_t kNameBytes = 1000;

/// Whether the batch itself writes a file that could be called so.
bool is_reserved(const std::string& first) {
  const bool is_report = first.starts_with("report.") || first.starts_with("failures.");
  return first == "index.html" || (is_report && first.ends_with(".jsonl"));
}

std::string refusal_of(const std::string& text, const std::filesystem::path& path) {
  const std::string shown_name = shown(Json(text));
  if (text.empty() || path.empty() || path == ".") return shown_name + " is no name";
  if (text.find('\0') != std::string::npos) return shown_name + " has a zero byte";
  if (path.is_absolute()) return shown_name + " is an absolute path";
  if (*path.begin() == "..") return shown_name + " leaves the folder of the outputs";
  if (is_reserved(*path.begin())) return shown_name + " is a file that the batch itself writes";
  if (text.size() > kNameBytes) {
    return fmt::format("{} has more than {} bytes", shown_name, kNameBytes);
  }
  for (const std::filesystem::path& step : path) {
    if (step.native().size() > kStepBytes) {
      return fmt::format("{} has a part of more than {} bytes", shown_name, kStepBytes);
    }
  }
  return "";
}

}  // namespace

BatchName batch_name(const std::string& text) {
  std::filesystem::path path = std::filesystem::path(text).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // "nose/"
  return {path.string(), refusal_of(text, path)};
}

}  // namespace morphbake
