#include "cli/terminal.h"

#include <gtest/gtest.h>

#include <functional>

namespace morphbake::cli {
namespace {

struct Printed {
  std::string out;
  std::string log;
};

std::string content_of(std::FILE* file) {
  std::string text;
  std::rewind(file);
  for (int letter = std::fgetc(file); letter != EOF; letter = std::fgetc(file)) {
    text += static_cast<char>(letter);
  }
  std::fclose(file);
  return text;
}

/// What `use` prints on a terminal with `settings`.
Printed printed(const TerminalSettings& settings, const std::function<void(Terminal&)>& use) {
  std::FILE* out = std::tmpfile();
  std::FILE* log = std::tmpfile();
  Terminal terminal(settings, out, log);
  use(terminal);
  terminal.finish();
  return {content_of(out), content_of(log)};
}

Problem broken_field() {
  Problem problem;
  problem.code = "recipe.out-of-range";
  problem.location.file = "a.json";
  problem.location.pointer = "/fps";
  problem.message = "-1 is no frame rate";
  problem.hint = "write 30";
  return problem;
}

void tell_everything(Terminal& terminal) {
  terminal.progress({"solve", 0, 4});
  terminal.progress({"solve", 1, 4});
  terminal.problem(broken_field());
  terminal.note("done");
  terminal.report(R"({"frames": 3})", {"3 frames"});
  terminal.result("a.glb");
}

TEST(Terminal, ThrowsWhenStandardOutputIsFull) {
  std::FILE* full = std::fopen("/dev/full", "w");
  if (full == nullptr) GTEST_SKIP() << "no /dev/full here";
  Terminal terminal({}, full, stderr);
  terminal.result("a.glb");
  EXPECT_THROW(terminal.finish(), BakeError);
  std::fclose(full);
}

TEST(Terminal, WritesResultsApartFromTheLog) {
  const Printed text = printed({}, tell_everything);
  EXPECT_EQ(text.out, "a.glb\n");
  EXPECT_EQ(text.log,
            "solve ...\n"
            "a.json#/fps: error: -1 is no frame rate [recipe.out-of-range]\n  hint: write 30\n"
            "done\n3 frames\n");
}

TEST(Terminal, TellsOnlyProblemsWhenQuiet) {
  TerminalSettings settings;
  settings.quiet = true;
  const Printed text = printed(settings, tell_everything);
  EXPECT_EQ(text.out, "a.glb\n");
  EXPECT_EQ(text.log,
            "a.json#/fps: error: -1 is no frame rate [recipe.out-of-range]\n  hint: write 30\n");
}

TEST(Terminal, WritesOneJsonObjectALine) {
  TerminalSettings settings;
  settings.log = LogFormat::Json;
  const Printed text = printed(settings, tell_everything);
  EXPECT_EQ(text.log,
            R"({"severity":"info","stage":"solve"})"
            "\n"
            R"({"severity":"error","code":"recipe.out-of-range","file":"a.json","pointer":"/fps",)"
            R"("message":"-1 is no frame rate","hint":"write 30"})"
            "\n"
            R"({"severity":"info","message":"done"})"
            "\n"
            R"({"severity":"info","report":{"frames":3}})"
            "\n");
}

TEST(Terminal, ReplacesBytesThatAreNoUtf8InJson) {
  TerminalSettings settings;
  settings.log = LogFormat::Json;
  const Printed text = printed(settings, [](Terminal& terminal) { terminal.note("a\xff"); });
  EXPECT_EQ(text.log, "{\"severity\":\"info\",\"message\":\"a\xEF\xBF\xBD\"}\n");
}

TEST(Terminal, ColoursOnlyTheSeverity) {
  TerminalSettings settings;
  settings.use_colour = true;
  const Printed text =
      printed(settings, [](Terminal& terminal) { terminal.problem(broken_field()); });
  EXPECT_EQ(text.log.substr(0, 36), "a.json#/fps: \033[1;31merror:\033[0m -1 is");
}

TEST(Terminal, ClearsTheBarBeforeAnyLine) {
  TerminalSettings settings;
  settings.show_bar = true;
  const Printed text = printed(settings, [](Terminal& terminal) {
    terminal.progress({"solve", 2, 4});
    terminal.note("done");
  });
  EXPECT_EQ(text.log, "\r\033[K[############            ]  50 %  solve\r\033[Kdone\n");
}

TEST(Terminal, TellsHowFarABatchIs) {
  BatchProgress progress;
  progress.total = 1000;
  progress.done = 420;
  progress.failed = 3;
  progress.per_second = 2.5;
  progress.seconds_left = 232;
  const auto told = [&](const TerminalSettings& settings) {
    return printed(settings,
                   [&](Terminal& terminal) {
                     terminal.progress(progress);
                     terminal.progress(progress);  // too soon for another line
                   })
        .log;
  };
  EXPECT_EQ(told({}), "420 of 1000, 3 failed, 2.5 a second, 4 min left\n");
  EXPECT_EQ(told({LogFormat::Json}),
            R"({"severity":"info","batch":{"done":420,"failed":3,"unchanged":0,"total":1000,)"
            R"("per_second":2.5,"seconds_left":232.0}})"
            "\n");
  TerminalSettings quiet;
  quiet.quiet = true;
  EXPECT_EQ(told(quiet), "");
  TerminalSettings bar;
  bar.show_bar = true;
  EXPECT_NE(told(bar).find("]  42 %  420 of 1000, 3 failed"), std::string::npos);
}

}  // namespace
}  // namespace morphbake::cli
