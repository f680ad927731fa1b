#pragma once

#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "morphbake/batch/run_batch.h"
#include "morphbake/diagnostics/observer.h"

namespace morphbake::cli {

enum class LogFormat { Text, Json };

struct TerminalSettings {
  LogFormat log = LogFormat::Text;
  bool quiet = false;     ///< no progress, no summary; problems are still told
  bool show_bar = false;  ///< a progress bar that is drawn over itself
  bool use_colour = false;
};

/// What suits the streams of this process: bar and colour only when stderr is a terminal (colour
/// not with NO_COLOR).
TerminalSettings settings_for_this_process(LogFormat log, bool quiet);

/// Every byte that the program prints: results on stdout, everything else on stderr.
///
/// LogFormat::Json makes each line on stderr one JSON object; a problem has severity, code, file,
/// pointer, message and hint (line and column when they are known), a stage has severity "info" and
/// stage.
class Terminal {
 public:
  explicit Terminal(TerminalSettings settings, std::FILE* out = stdout, std::FILE* log = stderr)
      : settings_(settings), out_(out), log_(log) {}

  /// Prints what the user asked for, and a line break.
  void result(std::string_view text);
  void problem(const Problem& problem);
  /// Prints prose for people; nothing with --quiet.
  void note(std::string_view text);
  void progress(const Progress& progress);
  /// How far a batch is: a bar on a terminal, else a line now and then.
  void progress(const BatchProgress& progress);
  /// Tells what a bake did: `lines` for people, `json_text` as one object with severity "info" and
  /// report.
  void report(std::string_view json_text, const std::vector<std::string>& lines);

  /// Finishes the bar and both streams.
  /// @throws BakeError "output.unwritable" when stdout did not take everything
  void finish();

  /// Shows progress and warnings here and stops on Ctrl-C.
  Observer observer();

 private:
  void print_log(std::string_view line);
  void draw_bar(int percent);
  void clear_bar();

  TerminalSettings settings_;
  std::FILE* out_;
  std::FILE* log_;
  std::string stage_;
  int percent_ = -1;
  std::chrono::steady_clock::time_point last_told_;  ///< how far a batch is
  bool bar_is_drawn_ = false;
};

}  // namespace morphbake::cli
