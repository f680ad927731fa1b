#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace morphbake {

enum class Severity { Warning, Error };

/// Where a problem is: a file, and inside it a JSON pointer (recipes and glTF alike).
struct Location {
  std::string file;
  std::string pointer;  ///< RFC 6901, "" for the whole document
  int line = 0;         ///< 1-based; 0 when unknown (syntax errors and lists know it)
  int column = 0;       ///< 1-based; 0 when unknown
};

/// One thing that is wrong, and what would be right.
struct Problem {
  Severity severity = Severity::Error;
  std::string
      code;  ///< stable, dotted by module: "recipe.unknown-name"; listed in docs/problems.md
  Location location;
  std::string message;  ///< what is wrong, with the offending value
  std::string hint;     ///< what would be right; may be empty
};

/// "file#/pointer: error: message [code]", and the hint on a second line.
std::string format_problem(const Problem& problem);

/// The only exception that the library throws for the user's mistakes: carries all problems found.
class BakeError : public std::runtime_error {
 public:
  explicit BakeError(std::vector<Problem> problems);
  explicit BakeError(Problem problem);

  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Thrown at the next check after Observer::is_cancelled answered true.
class Cancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "cancelled"; }
};

}  // namespace morphbake
