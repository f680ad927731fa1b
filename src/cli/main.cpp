#include <fmt/core.h>

#include <exception>
#include <functional>
#include <new>
#include <string_view>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/interrupt.h"
#include "morphbake/diagnostics/bug.h"
#include "morphbake/version.h"

namespace morphbake::cli {

namespace {

constexpr const char* kDescription =
    "Bakes shape morphs into glTF: a recipe names source meshes, regions and timing;\n"
    "the bake gives the sources one connectivity, blends them region by region and\n"
    "writes a .glb with morph targets and a weights animation, with turntable previews.";

constexpr const char* kFooter = R"(
Examples:
  morphbake init egg.glb giraffe.glb         a first recipe: recipe.json
  morphbake validate recipe.json             what is wrong with it, all at once
  morphbake bake recipe.json -o out          the morph; prints the files it wrote
  morphbake plan recipe.json --explain       what a bake would do anew, and why
  morphbake batch 'library/*/recipe.json'    a whole library, in parallel; goes on where it was
  morphbake remesh recipe.json -o same       the sources on one new connectivity
  morphbake inspect out/morph.glb            targets, sizes, bounds
  morphbake preview out/morph.glb            turntable of any morph glTF
  morphbake preview --compare a.glb b.glb    side by side, and how their shapes change
  morphbake lint a.glb --profile web-three   what a client would read wrong
  morphbake diff old.glb new.glb             whether both show the same motion, and where not
  morphbake golden recipe.json               bakes, and compares with results that were accepted
  morphbake landmarks suggest a.glb b.glb    points that correspond, with pictures
  morphbake cache                            how much is kept for later bakes, and where
  morphbake config                           every option with its default
  source <(morphbake completion bash)        completes command lines in this shell
  morphbake manual | man -l -                all of this, and each command's own

Results go to stdout, everything else to stderr. NO_COLOR is respected.
Exit codes: 0 done, 1 bug, 2 usage or recipe, 3 some recipes of a batch failed,
            4 source mesh, 5 numerical, 6 cannot write, 130 interrupted; diff, golden, lint: 0 right, 1 wrong, 2 error
Documentation: docs/ and examples/ of the source; recipes: schemas/recipe.schema.json)";

struct GlobalFlags {
  std::string log = "text";
  bool quiet = false;
};

/// The command line itself may be wrong, and that too is to be told in the format it asks for.
LogFormat log_format_of(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const bool value_follows = argument == "--log" && i + 1 < argc;
    if (argument == "--log=json" || (value_follows && argv[i + 1] == std::string_view("json"))) {
      return LogFormat::Json;
    }
  }
  return LogFormat::Text;
}

/// The first word of the command line that could be a command; "" without one.
std::string_view command_word(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--log") {
      ++i;
    } else if (!argument.empty() && argument.front() != '-') {
      return argument;
    }
  }
  return "";
}

/// The message of a command line that CLI11 cannot parse.
std::string shown_error(const CLI::App& program, const CLI::ParseError& error,
                        std::string_view command_word) {
  if (!program.get_subcommands().empty()) return error.what();
  if (command_word.empty()) return "no command given";
  std::string names;
  for (const CLI::App* command : program.get_subcommands(std::function<bool(const CLI::App*)>())) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return fmt::format("'{}' is no command; there are {}", command_word, names);
}

void add_global_flags(CLI::App& program, GlobalFlags& flags) {
  program.fallthrough();  // global flags may also follow the command
  program.require_subcommand(1);
  program.set_version_flag("--version", version_with_commit(), "Print the version");
  program.add_option("--log", flags.log, "What goes to stderr: text, or json (an object a line)")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  program.add_flag("--quiet", flags.quiet, "Only problems on stderr: no progress, no summary");
  program.footer(kFooter);
}

ExitCode tell_bug(Terminal& terminal, std::string_view what) {
  terminal.problem(bug(std::string(what)));
  return ExitCode::Bug;
}

ExitCode tell_out_of_memory(Terminal& terminal) {
  Problem problem;
  problem.code = "memory.exhausted";
  problem.message = "not enough memory";
  problem.hint = "bake smaller meshes, or on a machine with more memory";
  terminal.problem(problem);
  return exit_code_of(problem.code);
}

/// Runs a command that judges. What keeps it from judging is told, and never taken for a verdict.
ExitCode judge(const Command& command, Terminal& terminal) {
  try {
    const bool is_same = command.judge(terminal);
    terminal.finish();
    return is_same ? ExitCode::Same : ExitCode::Different;
  } catch (const Cancelled&) {
    throw;
  } catch (const BakeError& error) {
    for (const Problem& problem : error.problems()) terminal.problem(problem);
  } catch (const std::bad_alloc&) {
    tell_out_of_memory(terminal);
  } catch (const std::exception& error) {
    tell_bug(terminal, error.what());
  }
  return ExitCode::Unjudged;
}

/// Reads the command line and runs its command.
///
/// @param terminal  is given the settings that the command line asks for
ExitCode run_program(int argc, char** argv, Terminal& terminal) {
  CLI::App program(kDescription, "morphbake");
  GlobalFlags flags;
  add_global_flags(program, flags);
  const std::vector<Command> commands = {
      add_init(program),     add_bake(program),   add_plan(program),       add_batch(program),
      add_validate(program), add_remesh(program), add_inspect(program),    add_lint(program),
      add_preview(program),  add_diff(program),   add_golden(program),     add_landmarks(program),
      add_cache(program),    add_config(program), add_completion(program), add_manual(program)};
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    terminal.result(fmt::format("morphbake {}", version_with_commit()));
    return ExitCode::Done;
  } catch (const CLI::CallForHelp&) {
    terminal.result(program.help());
    return ExitCode::Done;
  } catch (const CLI::ParseError& error) {
    throw usage_error(shown_error(program, error, command_word(argc, argv)),
                      "see morphbake --help, or morphbake COMMAND --help");
  }
  const LogFormat log = flags.log == "json" ? LogFormat::Json : LogFormat::Text;
  terminal = Terminal(settings_for_this_process(log, flags.quiet));
  for (const Command& command : commands) {
    if (!command.parser->parsed()) continue;
    if (command.judge) return judge(command, terminal);
    if (command.conclude) return command.conclude(terminal);
    command.run(terminal);
  }
  return ExitCode::Done;
}

ExitCode guarded_run(int argc, char** argv, Terminal& terminal) {
  try {
    const ExitCode code = run_program(argc, argv, terminal);
    terminal.finish();
    return code;
  } catch (const BakeError& error) {
    for (const Problem& problem : error.problems()) terminal.problem(problem);
    return exit_code_of(error.problems());
  } catch (const Cancelled&) {
    terminal.note("interrupted; nothing was written");
    return ExitCode::Interrupted;
  } catch (const std::bad_alloc&) {
    return tell_out_of_memory(terminal);
  } catch (const std::exception& error) {
    return tell_bug(terminal, error.what());
  } catch (...) {
    return tell_bug(terminal, "an exception of an unknown type");
  }
}

}  // namespace
}  // namespace morphbake::cli

int main(int argc, char** argv) {
  using namespace morphbake::cli;
  catch_interrupts();
  Terminal terminal(settings_for_this_process(log_format_of(argc, argv), false));
  return static_cast<int>(guarded_run(argc, argv, terminal));
}
