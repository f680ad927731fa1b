#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <unordered_map>

#include "morphbake/bake/stage_keys.h"
#include "morphbake/batch/manifest.h"

namespace morphbake {

struct WholeRecipe;

/// Tells which recipes of a list share a new connectivity.
///
/// Of recipes that say the same of their sources and connectivity only the first is read with all
/// checks; a file whose entries change nothing of these is parsed once.
class ConnectivityKeys {
 public:
  ConnectivityKeys();
  ConnectivityKeys(const ConnectivityKeys&) = delete;
  ConnectivityKeys& operator=(const ConnectivityKeys&) = delete;
  ~ConnectivityKeys();

  /// The key of the new connectivity that a recipe asks for; "" where it has its sources' own, and
  /// where it cannot be read: its bake tells why.
  std::string of(const BatchEntry& entry);

 private:
  const WholeRecipe& whole(const std::filesystem::path& recipe);
  std::string read_key(const BatchEntry& entry);

  InputFiles files_;
  std::unordered_map<std::string, std::string> by_file_;  ///< of what changes leave as it is
  std::unordered_map<std::string, std::string> known_;    ///< key by hash of what recipes say
  std::unordered_map<std::string, int> failures_;         ///< to read them, likewise
  std::filesystem::path last_file_;
  std::unique_ptr<WholeRecipe> last_;
};

}  // namespace morphbake
