#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/completion.h"

namespace morphbake::cli {
namespace {

constexpr const char* kFooter = R"(
The package and `cmake --install` put these scripts where the shells look for them; this is for a
program that is not installed.

Example: source <(morphbake completion bash)
         morphbake completion fish > ~/.config/fish/completions/morphbake.fish)";

void run_completion(const CLI::App& program, const std::string& shell, Terminal& terminal) {
  const std::vector<ExpectedCommand> commands = expected_commands(program);
  std::string script = shell == "bash" ? bash_completion(commands) : fish_completion(commands);
  script.pop_back();  // results end their line themselves
  terminal.result(script);
}

}  // namespace

Command add_completion(CLI::App& program) {
  auto shell = std::make_shared<std::string>();
  CLI::App* parser =
      program.add_subcommand("completion", "Print a script that completes command lines");
  parser->add_option("SHELL", *shell, "Whose script")
      ->required()
      ->check(CLI::IsMember({"bash", "fish"}));
  parser->footer(kFooter);
  return {parser,
          [&program, shell](Terminal& terminal) { run_completion(program, *shell, terminal); }};
}

}  // namespace morphbake::cli
