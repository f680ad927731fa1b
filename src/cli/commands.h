#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/exit_code.h"
#include "cli/terminal.h"
#include "morphbake/cache/stage_cache.h"
#include "morphbake/diff/diff_options.h"
#include "morphbake/gltf/mesh_choice.h"
#include "morphbake/recipe/recipe.h"

namespace CLI::detail {

/// Help and shell completion tell files from other texts.
template <>
constexpr const char* type_name<std::filesystem::path>() {
  return "PATH";
}

}  // namespace CLI::detail

namespace morphbake::cli {

/// A command of the program: how it is written, and what it does when it was: one of these.
struct Command {
  CLI::App* parser = nullptr;
  std::function<void(Terminal&)> run;
  std::function<bool(Terminal&)> judge = {};  ///< exit code 0 when true, 1 when not, 2 for errors
  std::function<ExitCode(Terminal&)> conclude = {};  ///< has an exit code of its own
};

Command add_init(CLI::App& program);
Command add_bake(CLI::App& program);
Command add_plan(CLI::App& program);
Command add_batch(CLI::App& program);
Command add_validate(CLI::App& program);
Command add_remesh(CLI::App& program);
Command add_inspect(CLI::App& program);
Command add_lint(CLI::App& program);
Command add_preview(CLI::App& program);
Command add_diff(CLI::App& program);
Command add_golden(CLI::App& program);
Command add_landmarks(CLI::App& program);
Command add_cache(CLI::App& program);
Command add_config(CLI::App& program);
Command add_completion(CLI::App& program);
Command add_manual(CLI::App& program);

/// The option `--set /POINTER=VALUE`, which may be repeated.
void add_settings(CLI::App& parser, std::vector<std::string>& settings);

/// Numbers from `least` to `most`: CLI::Range takes "nan" as well.
CLI::Validator number_in(double least, double most);

/// Where results of stages are looked for and kept, as the command line says.
struct CacheArguments {
  std::string folder;  ///< "none": nowhere; empty: the user's own
  double gigabytes = 10;
};

/// The options `--cache` and `--cache-limit`, which MORPHBAKE_CACHE and MORPHBAKE_CACHE_LIMIT may
/// say as well.
void add_cache_options(CLI::App& parser, CacheArguments& arguments);

/// The cache of a run. The user's own is left out where it cannot be made.
StageCache cache_of(const CacheArguments& arguments);

/// The option `--node NAME`: whose mesh of a file is meant.
void add_node(CLI::App& parser, std::string& node);

/// What `--node` says: only digits are an index, all else a name, nothing no choice.
NameOrIndex name_or_index(const std::string& text);

/// The schema of that name that came with this program, installed or as built in the source tree;
/// empty when there is none.
std::filesystem::path shipped_schema_file(const char* name);

/// How a loop of pictures is asked for.
struct LoopArguments {
  std::string size = "512x512";
  int frames = PreviewRequest{}.frames;
  std::vector<std::string> formats = {"gif", "sheet"};
};

/// The options `--size`, `--frames` and `--formats`.
void add_loop(CLI::App& parser, LoopArguments& loop);

/// @throws BakeError "usage.bad-argument" for a size that is none
PreviewRequest request_of(const LoopArguments& loop);

/// The option `--preview recipe` or `none`.
void add_preview_choice(CLI::App& parser, bool& with_previews);

/// The options `--tolerance`, `--relative`, `--normals`, `--attributes`, `--strict` and
/// `--threads`.
void add_tolerances(CLI::App& parser, DiffOptions& options);

/// The error of a command line that cannot be meant: "usage.bad-argument".
BakeError usage_error(const std::string& message, const std::string& hint);

}  // namespace morphbake::cli
