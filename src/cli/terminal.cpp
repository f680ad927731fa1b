#include "cli/terminal.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/interrupt.h"
#include "morphbake/json/problem_json.h"

namespace morphbake::cli {
namespace {

constexpr int kBarWidth = 24;

std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json to_json(const BatchProgress& progress) {
  Json json = {{"done", progress.done},
               {"failed", progress.failed},
               {"unchanged", progress.unchanged},
               {"total", progress.total},
               {"per_second", progress.per_second}};
  if (progress.seconds_left) json["seconds_left"] = *progress.seconds_left;
  return json;
}

/// "40 s", "12 min", "3 h 20 min"
std::string shown_time(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  const long long minutes = std::llround(seconds / 60);
  return minutes < 100 ? fmt::format("{} min", minutes)
                       : fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

std::string shown(const BatchProgress& progress) {
  std::string text = fmt::format("{} of {}", progress.done, progress.total);
  if (progress.failed > 0) text += fmt::format(", {} failed", progress.failed);
  if (progress.seconds_left && progress.done < progress.total) {
    text += fmt::format(", {:.3g} a second, {} left", progress.per_second,
                        shown_time(*progress.seconds_left));
  }
  return text;
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
  // What cannot be written is told by finish().
  std::fwrite(text.data(), 1, text.size(), out_);
  std::fputc('\n', out_);
}

void Terminal::problem(const Problem& problem) {
  if (settings_.log == LogFormat::Json) return print_log(one_line(problem_to_json(problem)));
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

void Terminal::progress(const BatchProgress& progress) {
  using std::chrono::milliseconds;
  const auto now = std::chrono::steady_clock::now();
  const bool is_json = settings_.log == LogFormat::Json;
  const auto pause = milliseconds(settings_.show_bar ? 200 : is_json ? 1000 : 10000);
  const bool is_last = progress.done == progress.total;
  const bool is_nothing_new = progress.done == 0 && !settings_.show_bar;
  if (settings_.quiet || is_nothing_new || (!is_last && now - last_told_ < pause)) return;
  last_told_ = now;
  if (is_json) return print_log(one_line({{"severity", "info"}, {"batch", to_json(progress)}}));
  stage_ = shown(progress);
  if (!settings_.show_bar) return print_log(stage_);
  const double total = std::max(1.0, static_cast<double>(progress.total));
  draw_bar(static_cast<int>(100 * static_cast<double>(progress.done) / total));
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
