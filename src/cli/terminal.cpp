#include "cli/terminal.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "cli/interrupt.h"
#include "morphbake/json/json.h"

namespace morphbake::cli {
namespace {

constexpr int kBarWidth = 24;

std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json to_json(const Problem& problem) {
  Json json;
  json["severity"] = problem.severity == Severity::Error ? "error" : "warning";
  json["code"] = problem.code;
  json["file"] = problem.location.file;
  json["pointer"] = problem.location.pointer;
  if (problem.location.line > 0) {
    json["line"] = problem.location.line;
    json["column"] = problem.location.column;
  }
  json["message"] = problem.message;
  json["hint"] = problem.hint;
  return json;
}

/// `text` with its first "error:" in red or "warning:" in yellow.
std::string coloured(std::string text, Severity severity) {
  const std::string_view word = severity == Severity::Error ? "error:" : "warning:";
  const std::string_view colour = severity == Severity::Error ? "\033[1;31m" : "\033[1;33m";
  const std::size_t at = text.find(word);
  if (at != std::string::npos)
    text.replace(at, word.size(), fmt::format("{}{}\033[0m", colour, word));
  return text;
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

}  // namespace

TerminalSettings settings_for_this_process(LogFormat log, bool quiet) {
  const char* kind = std::getenv("TERM");
  const bool is_terminal =
      isatty(STDERR_FILENO) == 1 && kind != nullptr && kind != std::string_view("dumb");
  TerminalSettings settings;
  settings.log = log;
  settings.quiet = quiet;
  settings.show_bar = is_terminal && log == LogFormat::Text && !quiet;
  settings.use_colour = is_terminal && log == LogFormat::Text && !is_set("NO_COLOR");
  return settings;
}

void Terminal::result(std::string_view text) {
  clear_bar();
  fmt::print(out_, "{}\n", text);
}

void Terminal::problem(const Problem& problem) {
  if (settings_.log == LogFormat::Json) return print_log(one_line(to_json(problem)));
  std::string text = format_problem(problem);
  print_log(settings_.use_colour ? coloured(std::move(text), problem.severity) : text);
}

void Terminal::note(std::string_view text) {
  if (settings_.quiet) return;
  if (settings_.log == LogFormat::Text) return print_log(text);
  Json json;
  json["severity"] = "info";
  json["message"] = text;
  print_log(one_line(json));
}

void Terminal::progress(const Progress& progress) {
  if (settings_.quiet) return;
  const bool is_new_stage = progress.stage != stage_;
  stage_ = progress.stage;
  if (settings_.show_bar) {
    const double share = progress.total > 0 ? 1.0 * progress.done / progress.total : 0.0;
    const int percent = static_cast<int>(100 * std::clamp(share, 0.0, 1.0));
    if (is_new_stage || percent != percent_ || !bar_is_drawn_) draw_bar(percent);
  } else if (is_new_stage && settings_.log == LogFormat::Json) {
    Json json;
    json["severity"] = "info";
    json["stage"] = stage_;
    print_log(one_line(json));
  } else if (is_new_stage) {
    print_log(stage_ + " ...");
  }
}

void Terminal::report(std::string_view json_text, const std::vector<std::string>& lines) {
  if (settings_.quiet) return;
  if (settings_.log == LogFormat::Text) {
    for (const std::string& line : lines) print_log(line);
    return;
  }
  Json json;
  json["severity"] = "info";
  json["report"] = parse_json(json_text, "report");
  print_log(one_line(json));
}

void Terminal::finish() {
  clear_bar();
  std::fflush(log_);
  if (std::fflush(out_) == 0 && std::ferror(out_) == 0) return;
  Problem problem;
  problem.code = "output.unwritable";
  problem.message = "standard output does not take what is printed";
  problem.hint = "is the disk full?";
  throw BakeError(problem);
}

Observer Terminal::observer() {
  Observer observer;
  observer.on_problem = [this](const Problem& told) { problem(told); };
  observer.on_progress = [this](const Progress& made) { progress(made); };
  observer.is_cancelled = [] { return is_interrupted(); };
  return observer;
}

void Terminal::print_log(std::string_view line) {
  clear_bar();
  fmt::print(log_, "{}\n", line);
  std::fflush(log_);
}

void Terminal::draw_bar(int percent) {
  const int filled = percent * kBarWidth / 100;
  fmt::print(log_, "\r\033[K[{:#>{}}{:>{}}] {:3} %  {}", "", filled, "", kBarWidth - filled,
             percent, stage_);
  std::fflush(log_);
  percent_ = percent;
  bar_is_drawn_ = true;
}

void Terminal::clear_bar() {
  if (!bar_is_drawn_) return;
  fmt::print(log_, "\r\033[K");
  std::fflush(log_);
  bar_is_drawn_ = false;
}

}  // namespace morphbake::cli
