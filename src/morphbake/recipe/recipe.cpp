#include "morphbake/recipe/recipe.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace morphbake {
namespace {

bool lies_in(std::string_view pointer, std::string_view part) {
  return pointer.starts_with(part) &&
         (pointer.size() == part.size() || pointer[part.size()] == '/');
}

}  // namespace

const RecipePart& part_at(const std::vector<RecipePart>& parts, std::string_view pointer) {
  const RecipePart* best = &parts.front();
  for (const RecipePart& part : parts) {
    if (part.pointer.size() >= best->pointer.size() && lies_in(pointer, part.pointer)) best = &part;
  }
  return *best;
}

const std::filesystem::path& written_in(const std::vector<RecipePart>& parts,
                                        std::string_view pointer) {
  return part_at(parts, pointer).file;
}

namespace {

/// In the order of Representation.
constexpr std::array kRepresentations = {"auto",   "laplacian", "rotation",
                                         "affine", "absolute",  "rigid"};

/// In the order of TargetKind.
constexpr std::array kTargetKinds = {"auto", "tracks", "keyframes", "basis", "frames"};

}  // namespace

std::string name_of(Representation representation) {
  return kRepresentations[static_cast<std::size_t>(representation)];
}

Representation representation_named(const std::string& name) {
  const auto found = std::find(kRepresentations.begin(), kRepresentations.end(), name);
  assert(found != kRepresentations.end());
  return static_cast<Representation>(found - kRepresentations.begin());
}

std::string name_of(TargetKind kind) { return kTargetKinds[static_cast<std::size_t>(kind)]; }

TargetKind target_kind_named(const std::string& name) {
  const auto found = std::find(kTargetKinds.begin(), kTargetKinds.end(), name);
  assert(found != kTargetKinds.end());
  return static_cast<TargetKind>(found - kTargetKinds.begin());
}

bool has_shares_an_axis(const Recipe& recipe) {
  const auto is_an_axis = [](const Shares& shares) { return shares.cols() > 1; };
  const auto edits_an_axis = [&](const Edit& edit) { return is_an_axis(edit.to); };
  return is_an_axis(recipe.timeline.start) ||
         std::any_of(recipe.timeline.tracks.begin(), recipe.timeline.tracks.end(),
                     [&](const Track& track) { return edits_an_axis(track.edit); }) ||
         std::any_of(recipe.states.begin(), recipe.states.end(), [&](const State& state) {
           return is_an_axis(state.mix) ||
                  std::any_of(state.edits.begin(), state.edits.end(), edits_an_axis);
         });
}

Location location_in(const Recipe& recipe, std::string pointer) {
  if (recipe.parts.empty()) return {recipe.file.string(), std::move(pointer), 0, 0};
  const RecipePart& part = part_at(recipe.parts, pointer);
  return {part.file.string(), std::move(pointer), part.line, part.column};
}

}  // namespace morphbake
