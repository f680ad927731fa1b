#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {

/// Collects the names of a list's entries, and what is wrong with the list.
class EntryNames {
 public:
  /// Takes the next entry's name.
  ///
  /// @param hint  what to do about a name that can be none
  /// @return      whether it is one, which no other has
  bool take(const std::string& text, const Location& at, const std::string& hint);

  /// Notes what is wrong; the hundredth is the last.
  ///
  /// @throws BakeError when there are too many
  void complain(Problem problem);
  void complain(const BakeError& error);

  /// @param hint  what to do where there is no name
  /// @throws BakeError with all problems; "batch.empty" when there is no name
  std::vector<std::string> finish(const Location& at, const std::string& hint);

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, int> lines_;  ///< of names
  std::vector<Problem> problems_;
};

}  // namespace morphbake
