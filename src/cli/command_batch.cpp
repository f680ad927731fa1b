#include <fmt/core.h>

#include <charconv>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "morphbake/bake/options.h"
#include "morphbake/batch/run_batch.h"

namespace morphbake::cli {
namespace {

constexpr const char* kFooter = R"(
A list (.jsonl) has a recipe a line: "nose.json", or with a name and changes
  {"recipe": "nose.json", "name": "long", "set": {"/timeline/duration": 4}}
A table (--table, .csv) has a recipe a row; its columns are "name" and JSON pointers as /timeline/duration.
A pattern stands in quotes, so that the shell leaves it alone: 'library/**/recipe.json'

Each recipe is baked in a process of its own, into a folder of its name. OUT/report.jsonl has a line each,
OUT/failures.jsonl those that failed. The same command again bakes what failed, what was not reached,
and what has changed.

Exit codes: 0 all done, 2 usage or list, 3 some recipes failed, 6 cannot write, 130 interrupted.
Page: docs/batch.md

Example: morphbake batch 'library/*/recipe.json' -o out --html
         morphbake batch recipe.json --table lengths.csv -o out -j 8 --timeout 600
         morphbake batch library.jsonl -o out --shard 3/20       on each of 20 machines, then
         morphbake batch library.jsonl -o out --collect --html)";

struct Arguments {
  std::filesystem::path manifest;
  std::filesystem::path table;
  std::string shard;
  CacheArguments cache;
  BatchOptions options;
  bool collect = false;
};

/// A whole number, or 0.
int number_of(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

/// @throws BakeError "usage.bad-argument"
Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = std::min(text.find('/'), text.size());
  const int index = number_of(text.substr(0, slash));
  const int count = slash < text.size() ? number_of(text.substr(slash + 1)) : 0;
  if (index >= 1 && count >= index) return {index, count};
  throw usage_error(fmt::format("--shard: '{}' is no part of a whole", text),
                    "write --shard 1/4 for the first of four");
}

void check(const Arguments& arguments) {
  const bool is_sharded = !arguments.shard.empty();
  if (is_sharded && arguments.collect) {
    throw usage_error("--collect joins all shards: it goes without --shard",
                      "run the shards first, then the same command with --collect instead");
  }
  if (is_sharded && arguments.options.write_page) {
    throw usage_error("--html is a page of the whole list: it goes without --shard",
                      "write it with --collect --html once the shards are done");
  }
  read_options("{}", "", arguments.options.settings);  // what is wrong with them is told once
}

void tell_failure(const BatchRecord& record, Terminal& terminal) {
  for (Problem problem : record.problems) {
    problem.message = fmt::format("{}: {}", record.name, problem.message);
    terminal.problem(problem);
  }
}

std::string summary_of(const BatchResult& result) {
  const BatchProgress& progress = result.progress;
  std::string text = fmt::format("{} of {} done", progress.done - progress.failed, progress.total);
  if (progress.unchanged > 0) text += fmt::format(", {} of them before", progress.unchanged);
  if (progress.failed > 0) {
    text += fmt::format("; {} failed{}", progress.failed,
                        result.failures.empty() ? "" : ": " + result.failures.string());
  }
  return text;
}

ExitCode run(Arguments& arguments, Terminal& terminal) {
  arguments.options.shard = shard_of(arguments.shard);
  arguments.options.cache = cache_of(arguments.cache);
  check(arguments);
  BatchObserver observer;
  observer.on_failure = [&](const BatchRecord& record) { tell_failure(record, terminal); };
  observer.on_progress = [&](const BatchProgress& progress) { terminal.progress(progress); };
  observer.is_cancelled = is_interrupted;
  const Manifest manifest = read_manifest(arguments.manifest, arguments.table);
  const auto work = arguments.collect ? collect_batch : run_batch;
  const BatchResult result = work(manifest, arguments.options, observer);
  if (result.is_interrupted) {
    terminal.note(summary_of(result) + "; interrupted: the same command goes on from here");
    return ExitCode::Interrupted;
  }
  terminal.result(result.report.string());
  if (!result.page.empty()) terminal.result(result.page.string());
  terminal.note(summary_of(result));
  return result.progress.failed == 0 ? ExitCode::Done : ExitCode::SomeFailed;
}

void add_limits(CLI::App& parser, BatchOptions& options) {
  parser
      .add_option("-j,--processes", options.processes,
                  "Recipes that are baked at once; 0: as many as there are cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  parser
      .add_option("--threads", options.threads,
                  "Of each process; 0: all cores; changes the time, never a byte")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  parser.add_option("--timeout", options.timeout, "Seconds that a recipe may take; 0: any number")
      ->check(number_in(0, 1e9))
      ->capture_default_str();
  parser
      .add_option("--memory", options.memory,
                  "GB that a recipe may take beyond the program's own; 0: any number")
      ->check(number_in(0, 1e6))
      ->capture_default_str();
}

}  // namespace

Command add_batch(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand(
      "batch", "Bake a library of recipes, each in a process of its own; goes on where it was");
  BatchOptions& options = arguments->options;
  parser
      ->add_option("MANIFEST", arguments->manifest,
                   "A list of recipes (.jsonl), a pattern in quotes, or one recipe (.json)")
      ->required();
  parser
      ->add_option("-o,--output-dir", options.folder,
                   "Folder of the report and of all outputs, a folder a recipe in it")
      ->capture_default_str();
  parser->add_option("--table", arguments->table,
                     "With one recipe: rows of changes (.csv, or .jsonl of objects)");
  add_limits(*parser, options);
  parser
      ->add_option("--shard", arguments->shard,
                   "Bake one of N parts; recipes that share a connectivity are in one")
      ->type_name("I/N");
  parser->add_flag("--collect", arguments->collect, "Bake nothing: join the reports of the shards");
  parser->add_flag("--html", options.write_page, "Write OUT/index.html: a page of all recipes");
  add_settings(*parser, options.settings);
  add_preview_choice(*parser, options.with_previews);
  add_cache_options(*parser, arguments->cache);
  parser->footer(kFooter);
  Command command{parser, {}, {}};
  command.conclude = [arguments](Terminal& terminal) { return run(*arguments, terminal); };
  return command;
}

}  // namespace morphbake::cli
