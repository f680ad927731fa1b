// Fuzz target: the text of a landmark file. What was read is written, and must read as the same.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "fuzz/fuzz_folder.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/recipe/read_landmarks.h"

// NOLINTNEXTLINE: libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace morphbake;
  static const fuzz::FuzzFolder folder;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const std::vector<Landmark> landmarks =
        read_landmarks(folder.write("a.landmarks.json", text), "a.landmarks.json");
    const std::string written = landmarks_to_json(landmarks, folder.path / "b.json", {});
    const std::vector<Landmark> again = read_landmarks(folder.write("b.json", written), "b.json");
    if (landmarks_to_json(again, folder.path / "b.json", {}) != written) std::abort();
  } catch (const BakeError&) {
    // What is wrong was told.
  }
  return 0;
}
