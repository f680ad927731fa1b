#include "cli/commands.h"

namespace morphbake::cli {

std::filesystem::path shipped_schema_file(const char* name) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  for (const char* folder : {"../share/morphbake/schemas", "../../schemas"}) {
    const std::filesystem::path file = program.parent_path() / folder / name;
    if (std::filesystem::is_regular_file(file, error)) return file;
  }
  return {};
}

}  // namespace morphbake::cli
