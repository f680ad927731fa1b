// Fuzz target: the text of a recipe, beside two sources and a landmark file.

#include <cstdint>
#include <string_view>

#include "fuzz/fuzz_folder.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::fuzz {
namespace {

/// Sources are empty: a recipe's reader looks at their names only.
void write_sources(const FuzzFolder& folder) {
  for (const char* name : {"a.glb", "b.glb"}) folder.write(name, "");
  folder.write("a.landmarks.json",
               R"({"version": 1, "landmarks": {"nose": {"position": [0, 0, 1]}}})");
}

}  // namespace
}  // namespace morphbake::fuzz

// NOLINTNEXTLINE: libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace morphbake;
  static const fuzz::FuzzFolder folder;
  static const bool is_ready = (fuzz::write_sources(folder), true);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const Recipe recipe = read_recipe(folder.write("recipe.json", text));
    redirect_outputs(recipe, folder.path / "elsewhere");
  } catch (const BakeError&) {
    // What is wrong was told.
  }
  return is_ready ? 0 : 1;
}
