#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "morphbake/bake/bake.h"
#include "morphbake/files/files.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::cli {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> sources;
  std::filesystem::path recipe = "recipe.json";
  bool force = false;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const char* message, const char* hint) {
  throw BakeError(
      Problem{Severity::Error, "usage.would-overwrite", {file.string(), "", 0, 0}, message, hint});
}

void run_init(const Arguments& arguments, Terminal& terminal) {
  if (!arguments.force && std::filesystem::exists(arguments.recipe)) {
    refuse(arguments.recipe, "the file exists",
           "choose another name with --output, or overwrite it with --force");
  }
  for (const std::filesystem::path& source : arguments.sources) {
    std::error_code error;
    if (!std::filesystem::equivalent(source, arguments.recipe, error) || error) continue;
    refuse(arguments.recipe, "this is one of the sources", "choose another name with --output");
  }
  PendingOutputs outputs;
  const std::filesystem::path staged = outputs.stage(
      arguments.recipe,
      first_recipe(arguments.sources, arguments.recipe, shipped_schema_file("recipe.schema.json")));
  // What it writes shall bake: the sources must be glTF and share their triangles.
  validate(read_recipe(staged), {}, terminal.observer());
  outputs.commit();
  terminal.result(arguments.recipe.string());
  terminal.note(fmt::format("next: morphbake bake {}", arguments.recipe.string()));
}

}  // namespace

Command add_init(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand("init", "Write a first recipe that bakes");
  parser->add_option("SOURCES", arguments->sources, "glTF files, in the order of the morph")
      ->required()
      ->expected(2, 1000000);
  parser->add_option("-o,--output", arguments->recipe, "The recipe to write")
      ->capture_default_str();
  parser->add_flag("--force", arguments->force, "Overwrite it if it exists");
  parser->footer("\nExample: morphbake init egg.glb giraffe.glb -o egg-to-giraffe.json");
  return {parser, [arguments](Terminal& terminal) { run_init(*arguments, terminal); }};
}

}  // namespace morphbake::cli
