#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace morphbake::cli {

/// What may stand at a place of the command line.
struct ExpectedValue {
  enum class Kind { Anything, Words, Files, Folders };
  Kind kind = Kind::Anything;
  std::vector<std::string> words = {};    ///< all there are; beside Files, some that are none
  std::vector<std::string> endings = {};  ///< of files: "glb"; without any, all files

  bool operator==(const ExpectedValue&) const = default;
};

struct ExpectedOption {
  std::vector<std::string> names;  ///< "-o", "--output-dir"
  std::string description;
  bool takes_value = false;
  ExpectedValue value = {};
};

/// A command of the program, or the program itself, as shells complete it.
struct ExpectedCommand {
  std::string name;  ///< "landmarks suggest"; "" for the program
  std::string description;
  std::vector<std::string> commands;    ///< their last words
  std::vector<ExpectedOption> options;  ///< with those of the program, which may follow any command
  std::vector<ExpectedValue> arguments;
  bool repeats_last_argument = false;
};

/// What the command line's own definitions say: completion cannot differ from what is parsed.
///
/// @return  the program first, then its commands, each followed by its own
std::vector<ExpectedCommand> expected_commands(const CLI::App& program);

/// Scripts for the shells: bash (4 or later) and fish.
std::string bash_completion(const std::vector<ExpectedCommand>& commands);
std::string fish_completion(const std::vector<ExpectedCommand>& commands);

}  // namespace morphbake::cli
