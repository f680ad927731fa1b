#include <fmt/core.h>

#include <functional>
#include <string>

#include "cli/commands.h"
#include "morphbake/version.h"

namespace morphbake::cli {
namespace {

/// Text as it stands, in the language of manual pages.
std::string verbatim(const std::string& text) {
  std::string page = ".nf\n";
  bool begins_line = true;
  for (const char letter : text) {
    if (begins_line && (letter == '.' || letter == '\'')) page += "\\&";
    if (letter == '\\') {
      page += "\\e";
    } else if (letter == '-') {
      page += "\\-";
    } else {
      page += letter;
    }
    begins_line = letter == '\n';
  }
  return page + (begins_line ? "" : "\n") + ".fi\n";
}

std::string manual(const CLI::App& program) {
  std::string page =
      fmt::format(".TH MORPHBAKE 1 \"\" \"morphbake {}\" \"User Commands\"\n", version());
  page += ".SH NAME\nmorphbake \\- bakes shape morphs into glTF\n.SH SYNOPSIS\n";
  page += ".B morphbake\n.I COMMAND\n[\\fIARGUMENTS\\fR]\n.SH DESCRIPTION\n";
  page += verbatim(
      program.get_formatter()->make_help(&program, "morphbake", CLI::AppFormatMode::Normal));
  const auto all = std::function<bool(const CLI::App*)>();
  for (const CLI::App* command : program.get_subcommands(all)) {
    page += ".SH " + command->get_name() + "\n";
    page += verbatim(command->help("morphbake"));
    for (const CLI::App* part : command->get_subcommands(all)) {
      page += ".SS " + command->get_name() + " " + part->get_name() + "\n";
      page += verbatim(part->help("morphbake " + command->get_name()));
    }
  }
  return page;
}

}  // namespace

Command add_manual(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("manual", "Print the manual page, of all commands");
  parser->footer("\nExample: morphbake manual | man -l -");
  return {parser, [&program](Terminal& terminal) {
            std::string page = manual(program);
            page.pop_back();  // a result ends its line itself
            terminal.result(page);
          }};
}

}  // namespace morphbake::cli
