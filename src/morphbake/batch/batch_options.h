#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/batch/report_file.h"
#include "morphbake/cache/stage_cache.h"

namespace morphbake {

/// How a list of recipes is baked.
struct BatchOptions {
  std::filesystem::path folder = "out";  ///< of all outputs, each recipe's in one of its name
  int processes = 0;                     ///< at once; 0: as many as cores
  int threads = 1;                       ///< of each process; never changes a byte
  double timeout = 0;                    ///< seconds for each recipe; 0: any time
  double memory = 0;          ///< GB of address space for each recipe beyond the program's; 0: any
  bool with_previews = true;  ///< false leaves the recipes' previews out
  std::vector<std::string> settings;  ///< "/basis/easing_tolerance=1e-7" each, of all recipes
  Shard shard;                        ///< the part of the list that is baked
  bool write_page = false;            ///< index.html
  StageCache cache;
};

}  // namespace morphbake
