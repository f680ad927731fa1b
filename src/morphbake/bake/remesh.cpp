#include "morphbake/bake/remesh.h"

#include <fmt/core.h>

#include <map>
#include <utility>

#include "morphbake/bake/connect_sources.h"
#include "morphbake/bake/connectivity_sheet.h"
#include "morphbake/bake/load_sources.h"
#include "morphbake/bake/share_sources.h"
#include "morphbake/files/files.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// Names that only some file systems tell apart are equal here.
std::string small_letters(std::string name) {
  for (char& letter : name) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return name;
}

/// Sources whose names cannot be those of files, or of one file.
std::vector<Problem> name_problems(const Recipe& recipe) {
  std::vector<Problem> problems;
  std::map<std::string, std::string> taken;
  const auto complain = [&](const SourceRef& source, std::string message, const char* hint) {
    problems.push_back({Severity::Error, "recipe.bad-value",
                        location_in(recipe, child_pointer("/sources", source.name)),
                        std::move(message), hint});
  };
  for (const SourceRef& source : recipe.sources) {
    const bool is_folder = source.name == "." || source.name == "..";
    if (is_folder || source.name.find_first_of("/\\") != std::string::npos) {
      complain(source, fmt::format("\"{}\" is no file name", source.name),
               is_folder ? "the source's name becomes that of a file: use letters"
                         : "the source's name becomes that of a file: leave slashes out");
    }
    const auto [entry, is_new] = taken.try_emplace(small_letters(source.name), source.name);
    if (is_new) continue;
    complain(source,
             fmt::format("\"{}\" and \"{}\" are one file on Windows and macOS", entry->second,
                         source.name),
             "the sources' names become those of files: let them differ in more than capitals");
  }
  return problems;
}

/// Before any work: whether there is work, and whether it would replace what it reads.
void check_request(const Recipe& recipe, const std::vector<fs::path>& files) {
  std::vector<Problem> problems;
  if (recipe.connectivity.mode == ConnectivityMode::Shared) {
    problems.push_back({Severity::Error, "recipe.bad-value",
                        location_in(recipe, "/connectivity/mode"),
                        "the mode \"shared\" makes no new triangles",
                        "write \"connectivity\": {\"mode\": \"remesh\"} or \"resample\""});
  }
  for (Problem& problem : name_problems(recipe)) problems.push_back(std::move(problem));
  for (const fs::path& file : files) {
    for (const SourceRef& source : recipe.sources) {
      std::error_code error;
      const bool is_same = fs::absolute(file).lexically_normal() == source.file;
      if (!is_same && !fs::equivalent(file, source.file, error)) continue;
      problems.push_back({Severity::Error, "recipe.overwrites-source",
                          location_in(recipe, child_pointer("/sources", source.name)),
                          fmt::format("{} would replace a source", file.string()),
                          "write into another folder with --output-dir"});
    }
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
}

/// Fails now rather than after the work when the files cannot be written; leaves nothing.
void check_writable(const std::vector<fs::path>& files) {
  PendingOutputs never_committed;
  for (const fs::path& file : files) never_committed.stage(file, "");
}

}  // namespace

std::vector<fs::path> remeshed_files(const Recipe& recipe, const fs::path& folder,
                                     SheetRequest sheet) {
  std::vector<fs::path> files;
  for (const SourceRef& source : recipe.sources) files.push_back(folder / (source.name + ".glb"));
  files.push_back(folder / (recipe.name + ".maps.bin"));
  if (sheet == SheetRequest::Make) files.push_back(folder / (recipe.name + ".connectivity.png"));
  return files;
}

RemeshReport remesh(const Recipe& asked, const BakeOptions& options, const fs::path& folder,
                    SheetRequest sheet, const Observer& caller) {
  RemeshReport result;
  result.recipe = asked.name;
  result.files = remeshed_files(asked, folder, sheet);
  check_request(asked, result.files);
  check_writable(result.files);
  const Observer observer = recording(caller, result.problems);
  StageClock clock(observer);
  clock.start("sources");
  const auto [recipe, sources] = load_aligned(asked, observer);
  check_connected_alike(recipe, sources, folder / (recipe.name + ".mismatch.png"), options,
                        observer);
  const RemeshedSources remeshed = remesh_sources(recipe, sources, clock, observer);
  clock.start("measure");
  ConnectivityReport& connectivity = result.connectivity;
  connectivity.mode = recipe.connectivity.mode;
  connectivity.vertices = remeshed.triangulation.connectivity.vertex_count;
  connectivity.triangles = static_cast<int>(remeshed.triangulation.connectivity.triangles.rows());
  connectivity.repairs = repairs_of(remeshed);
  connectivity.texture = texture_report(remeshed);
  connectivity.quality = measured(recipe, remeshed, observer);
  PendingOutputs outputs;
  const std::size_t count = sources.size();
  if (sheet == SheetRequest::Make) {
    clock.start("sheet");
    const Image picture = connectivity_sheet(sources, remeshed, options, observer);
    outputs.stage(result.files[count + 1], encode_png(picture));
  }
  clock.start("write");
  for (std::size_t s = 0; s < count; ++s) {
    outputs.stage(result.files[s], remeshed.files.glbs[s]);
  }
  outputs.stage(result.files[count], remeshed.files.maps);
  outputs.commit();
  connectivity.steps = clock.finish();
  return result;
}

}  // namespace morphbake
