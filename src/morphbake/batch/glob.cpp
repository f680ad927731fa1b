#include "morphbake/batch/glob.h"

#include <fnmatch.h>

#include <algorithm>
#include <string_view>

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// The names of a folder; none where it cannot be read.
std::vector<fs::directory_entry> entries_of(const fs::path& folder) {
  std::vector<fs::directory_entry> entries;
  std::error_code error;
  fs::directory_iterator entry(folder.empty() ? "." : folder, error);
  while (!error && entry != fs::directory_iterator()) {
    entries.push_back(*entry);
    entry.increment(error);
  }
  return entries;
}

/// Adds what `steps` from the one at `index` on name below `folder`.
void add_matches(const fs::path& folder, const std::vector<std::string>& steps, std::size_t index,
                 std::vector<fs::path>& found) {
  std::error_code error;
  const std::string& step = steps[index];
  const bool is_last = index + 1 == steps.size();
  if (step == "**") {
    if (!is_last) add_matches(folder, steps, index + 1, found);
    for (const fs::directory_entry& entry : entries_of(folder)) {
      const std::string name = entry.path().filename();
      if (name.starts_with('.')) continue;
      const bool is_folder = entry.is_directory(error) && !entry.is_symlink(error);
      if (is_folder) add_matches(folder / name, steps, index, found);
      if (is_last && entry.is_regular_file(error)) found.push_back(folder / name);
    }
    return;
  }
  if (!is_pattern(step)) {
    const fs::path named = folder / step;
    if (is_last && fs::is_regular_file(named, error)) found.push_back(named);
    if (!is_last && fs::is_directory(named, error)) add_matches(named, steps, index + 1, found);
    return;
  }
  for (const fs::directory_entry& entry : entries_of(folder)) {
    const std::string name = entry.path().filename();
    if (fnmatch(step.c_str(), name.c_str(), FNM_PERIOD) != 0) continue;
    if (is_last && entry.is_regular_file(error)) found.push_back(folder / name);
    if (!is_last && entry.is_directory(error)) add_matches(folder / name, steps, index + 1, found);
  }
}

}  // namespace

bool is_pattern(const std::string& name) { return name.find_first_of("*?[") != std::string::npos; }

fs::path folder_before_wildcards(const std::string& pattern) {
  fs::path folder;
  for (const fs::path& step : fs::path(pattern)) {
    if (is_pattern(step)) break;
    folder /= step;
  }
  return folder;
}

std::vector<fs::path> files_matching(const std::string& pattern) {
  const fs::path folder = folder_before_wildcards(pattern);
  std::vector<std::string> steps;
  for (const fs::path& step : fs::path(pattern).lexically_relative(folder.empty() ? "." : folder)) {
    steps.push_back(step);
  }
  std::vector<fs::path> found;
  if (!steps.empty()) add_matches(folder, steps, 0, found);
  std::erase_if(found, [](const fs::path& file) {
    return file.string().ends_with(".landmarks.json");  // beside meshes, never recipes
  });
  std::ranges::sort(found, {}, [](const fs::path& file) { return file.string(); });
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace morphbake
