#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/bake/options.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/mesh_choice.h"
#include "morphbake/preview/motion_measures.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// Files that are compared, and where their pictures go.
struct ComparedPaths {
  std::vector<std::filesystem::path> gltf_files;  ///< one or more
  std::filesystem::path stem;                     ///< "dir/name"
  NameOrIndex node = {};                          ///< whose mesh, in each file; none: the first one
  NameOrIndex animation = {};  ///< of its weights, in each file; none: the last one
};

/// One file of a comparison.
struct ComparedMorph {
  std::string file;
  std::string label;  ///< its name, or as much of its path as tells it apart
  int node = 0;
  double begin = 0;  ///< seconds: first key of the animation
  double end = 0;    ///< last key
  int vertices = 0;  ///< of the welded surface
  int triangles = 0;
  int edges = 0;
  bool is_closed = false;
  MotionMeasures measures;
};

struct Comparison {
  std::vector<double> times;  ///< seconds, rising: from the first key of any file to the last
  std::vector<ComparedMorph> morphs;
  std::vector<std::filesystem::path> pictures;  ///< the files written
};

/// Measures morphs over one clock and renders them side by side: stem.gif, stem.sheet.png,
/// stem.frames/0000.png ...
///
/// Warns of surfaces that tear: "preview.torn".
/// @param request  its size is that of one file's picture
/// @throws BakeError with the problems of all files: as read_animated_mesh and read_source,
///         "gltf.no-such-target" and "gltf.no-such-animation" for a file without; then as
///         render_side_by_side, "output.unwritable"; Cancelled
Comparison compare_morphs(const ComparedPaths& paths, const PreviewRequest& request,
                          const BakeOptions& options, const Observer& observer);

}  // namespace morphbake
