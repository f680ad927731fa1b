#include "cli/exit_code.h"

#include <algorithm>
#include <array>
#include <utility>

namespace morphbake::cli {
namespace {

using ModuleExitCode = std::pair<std::string_view, ExitCode>;

constexpr std::array<ModuleExitCode, 26> kExitCodes = {{
    {"usage", ExitCode::Recipe},
    {"options", ExitCode::Recipe},
    {"landmarks", ExitCode::Recipe},
    {"json", ExitCode::Recipe},
    {"recipe", ExitCode::Recipe},
    {"profile", ExitCode::Recipe},
    {"schema", ExitCode::Recipe},
    {"files", ExitCode::Recipe},
    {"derive", ExitCode::Recipe},
    {"batch", ExitCode::Recipe},
    {"gltf", ExitCode::SourceMesh},
    {"mesh", ExitCode::SourceMesh},
    {"sources", ExitCode::SourceMesh},
    {"image", ExitCode::SourceMesh},
    {"images", ExitCode::SourceMesh},
    {"correspondence", ExitCode::SourceMesh},
    {"connectivity", ExitCode::SourceMesh},
    {"differential", ExitCode::Numerical},
    {"linear", ExitCode::Numerical},
    {"transition", ExitCode::Numerical},
    {"solve", ExitCode::Numerical},
    {"basis", ExitCode::Numerical},
    {"export", ExitCode::Numerical},
    {"preview", ExitCode::Numerical},
    {"memory", ExitCode::Numerical},
    {"output", ExitCode::CannotWrite},
}};

bool is_json_of_gltf(const Problem& problem) {
  const std::string_view file = problem.location.file;
  return problem.code.starts_with("json.") && (file.ends_with(".gltf") || file.ends_with(".glb"));
}

}  // namespace

ExitCode exit_code_of(std::string_view problem_code) {
  const std::string_view module = problem_code.substr(0, problem_code.find('.'));
  const auto* found =
      std::find_if(kExitCodes.begin(), kExitCodes.end(),
                   [&](const ModuleExitCode& entry) { return entry.first == module; });
  return found == kExitCodes.end() ? ExitCode::Bug : found->second;
}

ExitCode exit_code_of(const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) {
    if (problem.severity != Severity::Error) continue;
    return is_json_of_gltf(problem) ? ExitCode::SourceMesh : exit_code_of(problem.code);
  }
  return ExitCode::Bug;
}

}  // namespace morphbake::cli
