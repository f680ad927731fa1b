#include "morphbake/diagnostics/problem.h"

#include <fmt/core.h>

#include <utility>

#include "morphbake/diagnostics/shown_text.h"

namespace morphbake {
namespace {

std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += format_problem(problem);
  }
  return text;
}

}  // namespace

std::string format_problem(const Problem& problem) {
  const Location& at = problem.location;
  std::string text = without_control_characters(at.file);
  if (!at.pointer.empty()) text += "#" + without_control_characters(at.pointer);
  if (at.line > 0) text += fmt::format(":{}", at.line);
  if (at.line > 0 && at.column > 0) text += fmt::format(":{}", at.column);
  if (!text.empty()) text += ": ";
  text += problem.severity == Severity::Error ? "error: " : "warning: ";
  text += fmt::format("{} [{}]", without_control_characters(problem.message), problem.code);
  if (!problem.hint.empty()) text += "\n  hint: " + without_control_characters(problem.hint);
  return text;
}

BakeError::BakeError(std::vector<Problem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

BakeError::BakeError(Problem problem) : BakeError(std::vector<Problem>{std::move(problem)}) {}

}  // namespace morphbake
