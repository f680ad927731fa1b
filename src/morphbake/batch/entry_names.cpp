#include "morphbake/batch/entry_names.h"

#include <fmt/core.h>

#include <utility>

#include "morphbake/batch/batch_name.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

constexpr std::size_t kMostProblems = 100;

}  // namespace

bool EntryNames::take(const std::string& text, const Location& at, const std::string& hint) {
  const auto [name, refusal] = batch_name(text);
  if (!refusal.empty()) {
    complain({Severity::Error, "batch.bad-name", at, refusal, hint});
    return false;
  }
  const auto [other, is_new] = lines_.emplace(name, at.line);
  if (!is_new) {
    const std::string where =
        other->second > 0 ? fmt::format("line {}", other->second) : "another recipe";
    complain({Severity::Error, "batch.duplicate-name", at,
              fmt::format("{} is the name of {} already", shown(Json(name)), where),
              "give one of both another \"name\": their outputs go to folders of these names"});
    return false;
  }
  names_.push_back(name);
  return true;
}

void EntryNames::complain(Problem problem) {
  problems_.push_back(std::move(problem));
  if (problems_.size() >= kMostProblems) throw BakeError(std::move(problems_));
}

void EntryNames::complain(const BakeError& error) {
  for (const Problem& problem : error.problems()) complain(problem);
}

std::vector<std::string> EntryNames::finish(const Location& at, const std::string& hint) {
  if (!problems_.empty()) throw BakeError(std::move(problems_));
  if (names_.empty()) {
    throw BakeError(Problem{Severity::Error, "batch.empty", at, "this names no recipe", hint});
  }
  lines_.clear();
  return std::move(names_);
}

}  // namespace morphbake
