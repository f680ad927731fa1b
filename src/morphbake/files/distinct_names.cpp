#include "morphbake/files/distinct_names.h"

#include <algorithm>
#include <set>

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// The last `count` parts of a path, with slashes.
std::string path_end(const fs::path& file, std::ptrdiff_t count) {
  const std::ptrdiff_t parts = std::distance(file.begin(), file.end());
  fs::path end;
  for (auto part = std::next(file.begin(), std::max<std::ptrdiff_t>(0, parts - count));
       part != file.end(); ++part) {
    end /= *part;
  }
  return end.generic_string();
}

/// Numbers what is there again from 2 on.
void number_repeated(std::vector<std::string>& names) {
  std::set<std::string> taken;
  for (std::string& name : names) {
    const std::string plain = name;
    for (int number = 2; !taken.insert(name).second; ++number) {
      name = plain + " (" + std::to_string(number) + ")";
    }
  }
}

}  // namespace

std::vector<std::string> distinct_names(const std::vector<fs::path>& files) {
  const std::size_t different = std::set<fs::path>(files.begin(), files.end()).size();
  std::ptrdiff_t longest = 1;
  for (const fs::path& file : files) {
    longest = std::max(longest, std::distance(file.begin(), file.end()));
  }
  std::vector<std::string> names;
  for (std::ptrdiff_t count = 1; count <= longest; ++count) {
    names.clear();
    for (const fs::path& file : files) names.push_back(path_end(file, count));
    if (std::set<std::string>(names.begin(), names.end()).size() == different) break;
  }
  number_repeated(names);
  return names;
}

}  // namespace morphbake
