#include <unistd.h>

#include <cstdlib>

#include "cli/commands.h"

namespace morphbake::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kMostGigabytes = 1e6;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// ~/.cache/morphbake, as the XDG Base Directory Specification has it; empty where it cannot be
/// used, of which nobody wants to hear who did not ask for it.
fs::path own_folder() {
  const fs::path home = variable("HOME"), xdg = variable("XDG_CACHE_HOME");
  const fs::path base = xdg.is_absolute() ? xdg : home.is_absolute() ? home / ".cache" : fs::path();
  if (base.empty()) return {};
  std::error_code error;
  fs::create_directories(base / "morphbake", error);
  return ::access((base / "morphbake").c_str(), W_OK | X_OK) == 0 ? base / "morphbake" : fs::path();
}

}  // namespace

void add_cache_options(CLI::App& parser, CacheArguments& arguments) {
  parser
      .add_option("--cache", arguments.folder,
                  "Folder that keeps what stages gave, for later bakes; `none` for none "
                  "(default: ~/.cache/morphbake)")
      ->type_name("FOLDER")
      ->envname("MORPHBAKE_CACHE");
  parser
      .add_option("--cache-limit", arguments.gigabytes,
                  "GB of it: what was not used for longest goes first")
      ->check(number_in(0, kMostGigabytes))
      ->envname("MORPHBAKE_CACHE_LIMIT")
      ->capture_default_str();
}

StageCache cache_of(const CacheArguments& arguments) {
  if (arguments.folder == "none") return {};
  const fs::path folder = arguments.folder.empty() ? own_folder() : fs::absolute(arguments.folder);
  if (folder.empty()) return {};
  return StageCache({folder, static_cast<std::uintmax_t>(arguments.gigabytes * 1e9)});
}

}  // namespace morphbake::cli
