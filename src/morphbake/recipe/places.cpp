#include "morphbake/recipe/places.h"

#include "morphbake/json/json.h"

namespace morphbake {
namespace {

void visit_list(std::vector<Place>& places, int source, const std::string& pointer,
                const PlaceVisitor& visit) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    visit(places[i], source, child_pointer(pointer, i), Whereabouts::OnSurface);
  }
}

void visit_region(RegionOfInterest& region, const PlaceVisitor& visit) {
  const std::string pointer = child_pointer("/regions", region.name);
  if (auto* ball = std::get_if<BallRegion>(&region.shape)) {
    visit(ball->centre, ball->source, pointer + "/ball/at", Whereabouts::OnSurface);
  } else if (auto* rings = std::get_if<RingsRegion>(&region.shape)) {
    visit_list(rings->inner, rings->source, pointer + "/rings/inner", visit);
    visit_list(rings->outer, rings->source, pointer + "/rings/outer", visit);
  } else if (auto* scattered = std::get_if<ScatteredRegion>(&region.shape)) {
    for (ScatteredValue& each : scattered->values) {
      visit(each.at, scattered->source, child_pointer(pointer + "/scattered/values", each.name),
            Whereabouts::OnSurface);
    }
  } else if (auto* flood = std::get_if<FloodRegion>(&region.shape)) {
    visit_list(flood->seeds, flood->source, pointer + "/flood/from", visit);
  }
}

void visit_handles(DerivedSource& derived, const PlaceVisitor& visit) {
  auto* edit = std::get_if<EditSource>(&derived.how);
  if (edit == nullptr) return;
  const std::string pointer = child_pointer("/sources", derived.name) + "/edit/handles";
  for (std::size_t i = 0; i < edit->handles.size(); ++i) {
    EditHandle& handle = edit->handles[i];
    const std::string at = child_pointer(pointer, i);
    if (handle.region < 0) visit(handle.at, derived.root, at + "/at", Whereabouts::OnSurface);
    auto* target = std::get_if<HandleTarget>(&handle.to);
    if (target != nullptr) visit(target->at, target->source, at + "/to", Whereabouts::Anywhere);
  }
}

}  // namespace

void visit_places(Recipe& recipe, const PlaceVisitor& visit) {
  for (RegionOfInterest& region : recipe.regions) visit_region(region, visit);
  for (DerivedSource& derived : recipe.derived) visit_handles(derived, visit);
  if (recipe.gauge.kind == Gauge::Kind::Landmark) {
    visit(recipe.gauge.at, recipe.gauge.source, "/gauge/landmark/at", Whereabouts::OnSurface);
  } else if (recipe.gauge.kind == Gauge::Kind::Anchor) {
    visit(recipe.gauge.at, recipe.gauge.source, "/gauge/anchor/at", Whereabouts::OnSurface);
  }
}

}  // namespace morphbake
