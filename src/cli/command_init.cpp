#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "cli/commands.h"
#include "morphbake/bake/bake.h"
#include "morphbake/bake/first_choices.h"
#include "morphbake/files/files.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::cli {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> sources;
  std::vector<std::string> nodes;
  std::filesystem::path recipe = "recipe.json";
  bool force = false;
};

/// One choice a source, or none.
std::vector<NameOrIndex> chosen_nodes(const Arguments& arguments) {
  const std::size_t sources = arguments.sources.size(), given = arguments.nodes.size();
  if (given > 1 && given != sources) {
    throw usage_error(fmt::format("--node is given {} times for {} sources", given, sources),
                      "give it once for all, or once for each");
  }
  std::vector<NameOrIndex> nodes;
  for (std::size_t i = 0; given > 0 && i < sources; ++i) {
    nodes.push_back(name_or_index(arguments.nodes[given == 1 ? 0 : i]));
  }
  return nodes;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const char* message, const char* hint) {
  throw BakeError(
      Problem{Severity::Error, "usage.would-overwrite", {file.string(), "", 0, 0}, message, hint});
}

/// What the recipe has to say, by a draft that is not kept.
FirstChoices choices_for(const Arguments& arguments, const Observer& observer) {
  FirstChoices asked;
  asked.nodes = chosen_nodes(arguments);
  PendingOutputs never_committed;
  const std::filesystem::path draft = never_committed.stage(
      arguments.recipe, first_recipe(arguments.sources, arguments.recipe, "", asked));
  Recipe recipe = read_recipe(draft);
  // Messages name what the user knows.
  recipe.file = arguments.recipe;
  for (std::size_t i = 0; i < arguments.sources.size(); ++i) {
    recipe.sources[i].file = arguments.sources[i];
  }
  FirstChoices choices = first_choices(recipe, observer);
  choices.nodes = std::move(asked.nodes);
  return choices;
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
  const std::filesystem::path schema = shipped_schema_file("recipe.schema.json");
  PendingOutputs outputs;
  const std::filesystem::path staged =
      outputs.stage(arguments.recipe, first_recipe(arguments.sources, arguments.recipe, schema,
                                                   choices_for(arguments, terminal.observer())));
  // What it writes shall bake.
  Recipe recipe = read_recipe(staged);
  recipe.file = arguments.recipe;
  validate(recipe, {}, terminal.observer());
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
  parser
      ->add_option(
          "--node", arguments->nodes,
          "The node whose mesh is meant, by its name or its index from 0, where a file has "
          "several: once for all sources, or once for each")
      ->allow_extra_args(false);
  parser->add_option("-o,--output", arguments->recipe, "The recipe to write")
      ->capture_default_str();
  parser->add_flag("--force", arguments->force, "Overwrite it if it exists");
  parser->footer("\nExample: morphbake init egg.glb giraffe.glb -o egg-to-giraffe.json");
  return {parser, [arguments](Terminal& terminal) { run_init(*arguments, terminal); }};
}

}  // namespace morphbake::cli
