// Fuzz target: a list of recipes, or a table of changes; the first byte says which. Each entry is
// read again.

#include <cstdint>
#include <string_view>

#include "fuzz/fuzz_folder.h"
#include "morphbake/batch/manifest.h"

// NOLINTNEXTLINE: libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace morphbake;
  static const fuzz::FuzzFolder folder;
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  const auto recipe = folder.write("recipe.json", "{}");
  try {
    const Manifest manifest =
        data[0] % 3 == 0
            ? read_manifest(folder.write("list.jsonl", text), {})
            : read_manifest(recipe,
                            folder.write(data[0] % 3 == 1 ? "table.csv" : "table.jsonl", text));
    for (std::size_t i = 0; i < manifest.names.size(); ++i) {
      const BatchEntry entry = entry_of(manifest, i);
      try {
        read_recipe(recipe, entry.changes);
      } catch (const BakeError&) {
        // The recipe is empty: what is tested is that its changes are made or refused.
      }
      if (i == 20) break;
    }
  } catch (const BakeError&) {
    // What is wrong was told.
  }
  return 0;
}
