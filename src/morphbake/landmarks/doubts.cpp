#include "morphbake/landmarks/doubts.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "morphbake/sources/common_landmarks.h"

namespace morphbake {
namespace {

constexpr double kMirrorFits = 0.3;       // of the distance without a mirror
constexpr double kMirrorMatters = 0.003;  // of the diagonal
constexpr double kUnlike = 0.28;          // `Alignment::cost` from which pairs are doubtful

void warn(const Observer& observer, const SourceSurface& surface, const char* code,
          std::string message, std::string hint) {
  report(observer,
         Problem{Severity::Warning, code, {surface.file, ""}, std::move(message), std::move(hint)});
}

}  // namespace

void warn_of_pieces(const Observer& observer, const SourceSurface& surface,
                    const ShapeSketch& sketch) {
  if (sketch.pieces == 1) return;
  warn(observer, surface, "landmarks.several-pieces",
       fmt::format("\"{}\" has {} pieces; landmarks are proposed on the largest", surface.name,
                   sketch.pieces),
       "give the other pieces landmarks by hand");
}

void warn_of_borders(const Observer& observer, const SourceSurface& a, const SourceSurface& b,
                     const ShapeSketch& sketch_a, const ShapeSketch& sketch_b) {
  if (sketch_a.boundary.empty() == sketch_b.boundary.empty()) return;
  const bool is_a_open = !sketch_a.boundary.empty();
  warn(observer, is_a_open ? a : b, "correspondence.different-topology",
       fmt::format("\"{}\" is open (it has a border) but \"{}\" is closed: they cannot be remeshed "
                   "together",
                   is_a_open ? a.name : b.name, is_a_open ? b.name : a.name),
       "cut or fill one of them");
}

void warn_of_mirror(const Observer& observer, const SourceSurface& a, const SourceSurface& b,
                    const Correspondences& all, const Alignment& kept) {
  const Alignment mirrored = align_shapes(all.a.sketch, all.b.sketch, Handedness::Mirrored);
  const double apart = surface_distance(all.a.sketch, all.b.sketch, kept, Handedness::Kept);
  const double in_mirror =
      surface_distance(all.a.sketch, all.b.sketch, mirrored, Handedness::Mirrored);
  if (!(apart > kMirrorMatters) || !(in_mirror < kMirrorFits * apart)) return;
  warn(observer, b, "landmarks.mirrored",
       fmt::format("\"{}\" is a mirror image of \"{}\": their surfaces differ by {:.2g} % of the "
                   "diagonal in a mirror, by {:.2g} % without",
                   b.name, a.name, 100 * in_mirror, 100 * apart),
       "mirror one of the files, or the morph turns inside out where they differ; the landmarks "
       "keep left to left");
}

void warn_if_uncertain(const Observer& observer, const SourceSurface& a, const SourceSurface& b,
                       const Correspondences& all, const Alignment& kept) {
  const auto matched =
      std::count_if(kept.partner.begin(), kept.partner.end(), [](int p) { return p >= 0; });
  const auto tips_a = static_cast<std::ptrdiff_t>(all.a.sketch.tips.size());
  const auto tips_b = static_cast<std::ptrdiff_t>(all.b.sketch.tips.size());
  const char* hint = "look at the sheet, and move the landmarks that are wrong";
  if (matched < static_cast<std::ptrdiff_t>(kFewestLandmarks) ||
      2 * matched < std::min(tips_a, tips_b)) {
    warn(observer, b, "landmarks.uncertain",
         fmt::format("{} tips of \"{}\" and {} of \"{}\" stand out, but only {} correspond; most "
                     "landmarks are guesses",
                     tips_a, a.name, tips_b, b.name, matched),
         hint);
  } else if (kept.cost > kUnlike) {
    warn(observer, b, "landmarks.uncertain",
         fmt::format(
             "the tips of \"{}\" and \"{}\" lie differently (by {:.2f}, where {:.2f} is usual "
             "at most); some landmarks are probably wrong",
             a.name, b.name, kept.cost, kUnlike),
         hint);
  }
}

}  // namespace morphbake
