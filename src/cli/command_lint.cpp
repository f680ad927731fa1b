#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/lint_text.h"

namespace morphbake::cli {
namespace {

constexpr const char* kFooter = R"(
A profile says what a client reads of morph targets. `morphbake lint --list` shows those that come
with morphbake, and all rules; one of your own is a .json file, whose path is told instead of a name
(schemas/profile.schema.json explains its fields).

Of many places alike the first is shown, with their number. Severities:
  error    against glTF 2.0, or read wrong by the profile's client
  warning  legal, but it costs something or looks like a mistake
  note     legal and read right; worth knowing

Exit codes: 0 no errors (with --strict: no warnings either), 1 some, 2 the file or the profile
cannot be read.

Example: morphbake lint morph.glb --profile web-three
         morphbake lint morph.glb --profile engines/ours.json --strict --json)";

struct Arguments {
  std::filesystem::path file;
  std::string profile;
  std::string node;
  LintOptions options;
  bool is_strict = false;
  bool json = false;
  bool list = false;
  bool hides_notes = false;
};

void add_arguments(CLI::App& parser, Arguments& arguments) {
  parser.add_option("FILE", arguments.file, "A .glb or .gltf file, whoever wrote it");
  parser
      .add_option("--profile", arguments.profile,
                  "The client: a name of --list, or the path of a .json file")
      ->type_name("PROFILE");
  parser.add_option("--node", arguments.node,
                    "The node whose mesh is meant, by its name in the file or its index from 0 "
                    "(default: all meshes with morph targets)");
  parser.add_flag("--loop", arguments.options.must_loop,
                  "Clips are to loop: their last key must be their first");
  parser.add_flag("--strict", arguments.is_strict, "Warnings count as errors");
  parser.add_flag("--no-notes", arguments.hides_notes, "Leave out what needs no doing");
  parser.add_flag("--json", arguments.json, "All of it as JSON (schemas/lint.schema.json)");
  parser.add_flag("--list", arguments.list, "Show all profiles and rules instead");
  parser.footer(kFooter);
}

bool run_lint(const Arguments& arguments, Terminal& terminal) {
  if (arguments.list) {
    for (const std::string& line : rule_lines()) terminal.result(line);
    return true;
  }
  if (arguments.file.empty() || arguments.profile.empty()) {
    throw usage_error(arguments.file.empty() ? "FILE is required" : "--profile is required",
                      "`morphbake lint --list` shows all profiles; see morphbake lint --help");
  }
  const Profile profile = read_profile(arguments.profile);
  const LintReport report =
      lint(open_gltf(arguments.file), profile, {.node = name_or_index(arguments.node)},
           arguments.options, terminal.observer());
  if (arguments.json) {
    terminal.result(lint_to_json(report));
  } else {
    for (const std::string& line : lint_lines(report, profile, arguments.hides_notes)) {
      terminal.result(line);
    }
  }
  const bool has_warnings = arguments.is_strict && count(report, FindingSeverity::Warning) > 0;
  return count(report, FindingSeverity::Error) == 0 && !has_warnings;
}

}  // namespace

Command add_lint(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser =
      program.add_subcommand("lint", "Tell what a client would read wrong in a glTF with targets");
  add_arguments(*parser, *arguments);
  Command command{parser, {}, {}};
  command.judge = [arguments](Terminal& terminal) { return run_lint(*arguments, terminal); };
  return command;
}

}  // namespace morphbake::cli
