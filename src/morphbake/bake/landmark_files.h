#pragma once

#include <filesystem>
#include <vector>

#include "morphbake/diagnostics/observer.h"

namespace morphbake {

/// What `morphbake landmarks suggest` is asked for.
struct LandmarkRequest {
  std::filesystem::path a;  ///< a glTF file
  std::filesystem::path b;
  std::filesystem::path folder;  ///< of all that is written; empty: beside the files
  std::filesystem::path schema;  ///< landmarks.schema.json for "$schema"; empty for none
  int count = 10;                ///< landmarks wanted, 3 to 100
  bool replace = false;          ///< whether files that exist are overwritten
  int threads = 0;               ///< 0: all cores; never changes a byte
};

/// Proposes landmarks for two files: writes A.landmarks.json, B.landmarks.json and a sheet of
/// pictures, A-B.landmarks.png, all or none.
///
/// @return  the files written
/// @throws BakeError "usage.would-overwrite", "usage.bad-argument", "landmarks....", "gltf....",
///         "connectivity....", "output...."; Cancelled
std::vector<std::filesystem::path> write_suggested_landmarks(const LandmarkRequest& request,
                                                             const Observer& observer);

/// Renders the landmarks of a file on its shape.
///
/// @param landmarks  a landmark file; empty: the one beside `file`
/// @param picture    the .png to write
/// @param threads    0: all cores; never changes a byte
/// @throws BakeError as write_suggested_landmarks
void write_landmark_sheet(const std::filesystem::path& file, const std::filesystem::path& landmarks,
                          const std::filesystem::path& picture, int threads,
                          const Observer& observer);

}  // namespace morphbake
