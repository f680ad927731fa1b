// Fuzz target: an entry of the cache, as bytes of a file, and as what stands behind a right hash:
// then every stage tries to make something of it.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "morphbake/bake/kept_stages.h"
#include "morphbake/cache/content_hash.h"

namespace morphbake::fuzz {
namespace {

void read_as_every_stage(const CacheEntry& entry) {
  constexpr Eigen::Index kVertices = 2;
  connectivity_of(entry, 1);
  geometries_of(entry, 1, kVertices);
  shapes_of(entry, 2, kVertices);
  output_of(entry, "a.glb");
  files_of(entry);
  BakeReport report;
  fill_in(entry, report);
  Recipe recipe;
  recipe.regions.resize(2);
  recipe.regions[0].shape = FloodRegion{};
  recipe.regions[1].shape = BallRegion{};
  regions_of(entry, recipe, kVertices);
}

void read_entry(std::string_view bytes) {
  const std::optional<CacheEntry> entry = entry_from_bytes(bytes);
  if (!entry) return;
  const auto again = entry_from_bytes(entry_to_bytes(*entry));
  if (!again || again->facts != entry->facts || again->blobs != entry->blobs) std::abort();
  read_as_every_stage(*entry);
}

}  // namespace
}  // namespace morphbake::fuzz

// NOLINTNEXTLINE: libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace morphbake;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  fuzz::read_entry(bytes);
  fuzz::read_entry("morphbake cache 1 " + content_hash(bytes) + "\n" + std::string(bytes));
  return 0;
}
