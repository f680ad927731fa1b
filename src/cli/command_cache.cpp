#include <fmt/core.h>

#include <memory>

#include "cli/commands.h"

namespace morphbake::cli {
namespace {

struct Arguments {
  CacheArguments cache;
  bool clear = false;
};

void run_cache(const Arguments& arguments, Terminal& terminal) {
  const StageCache cache = cache_of(arguments.cache);
  if (!cache.is_on()) {
    terminal.result("no cache");
    return;
  }
  const std::string folder = cache.options().folder.string();
  const CacheContents contents = cache.contents();
  const double megabytes = static_cast<double>(contents.bytes) / 1e6;
  if (arguments.clear) {
    cache.clear();
    terminal.result(
        fmt::format("{}: removed {} entries, {:.1f} MB", folder, contents.entries, megabytes));
    return;
  }
  terminal.result(fmt::format("{}: {} entries, {:.1f} MB of {:.1f}", folder, contents.entries,
                              megabytes, static_cast<double>(cache.options().size_limit) / 1e6));
}

}  // namespace

Command add_cache(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand("cache", "Tell what the cache holds, or empty it");
  parser->add_flag("--clear", arguments->clear, "Remove all that it holds");
  add_cache_options(*parser, arguments->cache);
  parser->footer("\nExample: morphbake cache --clear");
  return {parser, [arguments](Terminal& terminal) { run_cache(*arguments, terminal); }};
}

}  // namespace morphbake::cli
