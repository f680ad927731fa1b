#include "morphbake/gltf/draft_references.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "morphbake/gltf/check_document.h"

namespace morphbake {
namespace {

/// Visits each field of each object; nesting was bounded when the JSON was read.
///
/// @param is_extra  whether `json` lies in extras
template <typename AnyJson, typename Visit>
void for_each_field(AnyJson& json, bool is_extra, const Visit& visit) {
  if (json.is_array()) {
    for (auto& each : json) for_each_field(each, is_extra, visit);
  }
  if (!json.is_object()) return;
  for (auto field = json.begin(); field != json.end(); ++field) {
    visit(std::string_view(field.key()), field.value(), is_extra);
    for_each_field(field.value(), is_extra || field.key() == "extras", visit);
  }
}

enum class Part { Accessor, View };

/// Visits each number of an accessor or bufferView.
template <typename AnyJson, typename Visit>
void for_each_reference(AnyJson& json, const Visit& visit) {
  constexpr std::array<std::string_view, 4> kSingle = {"indices", "input", "output",
                                                       "inverseBindMatrices"};
  const auto visit_number = [&visit](Part part, auto& value, bool is_extra) {
    if (value.is_number_integer()) visit(part, value, is_extra);
  };
  const auto visit_values = [&visit_number](auto& fields, bool is_extra) {
    if (!fields.is_object()) return;
    for (auto& value : fields) visit_number(Part::Accessor, value, is_extra);
  };
  for_each_field(json, false, [&](std::string_view name, auto& value, bool is_extra) {
    if (name == "bufferView") visit_number(Part::View, value, is_extra);
    if (name == "attributes") visit_values(value, is_extra);
    if (name == "targets" && value.is_array()) {
      for (auto& target : value) visit_values(target, is_extra);
    }
    if (std::find(kSingle.begin(), kSingle.end(), name) != kSingle.end()) {
      visit_number(Part::Accessor, value, is_extra);
    }
  });
}

bool has_unknown_extension(const Json& json) {
  bool found = false;
  for_each_field(json, false, [&found](std::string_view name, const Json& value, bool is_extra) {
    if (name != "extensions" || is_extra || !value.is_object()) return;
    for (const auto& extension : value.items()) {
      found = found || !is_known_extension(extension.key());
    }
  });
  return found;
}

ByteRange bytes_of(const Json& view) {
  const auto begin = view.value("byteOffset", std::size_t{0});
  return {begin, begin + view.at("byteLength").get<std::size_t>()};
}

/// Ranges that do not touch, rising.
std::vector<ByteRange> merged(std::vector<ByteRange> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const ByteRange& a, const ByteRange& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  std::vector<ByteRange> apart;
  for (const ByteRange& range : ranges) {
    if (range.begin >= range.end) continue;
    if (apart.empty() || apart.back().end < range.begin) {
      apart.push_back(range);
    } else {
      apart.back().end = std::max(apart.back().end, range.end);
    }
  }
  return apart;
}

/// What of `ranges` no bufferView shows. Multiples of 4 bytes: whatever follows stays aligned.
std::vector<ByteRange> unseen_ranges(const GlbDraft& draft) {
  std::vector<ByteRange> shown, unseen;
  for (const Json& view : draft.views) shown.push_back(bytes_of(view));
  shown = merged(std::move(shown));
  const auto add = [&unseen](std::size_t begin, std::size_t end) {
    if (begin + 4 <= end) unseen.push_back({begin, begin + (end - begin) / 4 * 4});
  };
  auto next = shown.begin();
  for (auto [begin, end] : merged(draft.leftovers.bytes)) {
    end = std::min((end + 3) / 4 * 4, draft.binary.size());  // with what aligned the next one
    while (next != shown.end() && next->end <= begin) ++next;
    for (; next != shown.end() && next->begin < end; ++next) {
      add(begin, next->begin);
      begin = next->end;
      if (begin > end) break;  // it may reach into the next range too
    }
    add(begin, end);
  }
  return unseen;
}

/// Closes gaps in the buffer, which lie between bufferViews.
void close_gaps(GlbDraft& draft, const std::vector<ByteRange>& gaps) {
  std::string& binary = draft.binary;
  std::vector<std::size_t> closed = {0};  // bytes before the end of gap i - 1
  std::size_t to = gaps.empty() ? binary.size() : gaps.front().begin;
  for (std::size_t g = 0; g < gaps.size(); ++g) {
    const std::size_t end = g + 1 < gaps.size() ? gaps[g + 1].begin : binary.size();
    const auto first = binary.begin();
    std::copy(first + static_cast<std::ptrdiff_t>(gaps[g].end),
              first + static_cast<std::ptrdiff_t>(end), first + static_cast<std::ptrdiff_t>(to));
    to += end - gaps[g].end;
    closed.push_back(closed.back() + gaps[g].end - gaps[g].begin);
  }
  binary.resize(to);
  for (Json& view : draft.views) {
    const auto begin = view.value("byteOffset", std::size_t{0});
    const auto gap = std::partition_point(
        gaps.begin(), gaps.end(), [begin](const ByteRange& each) { return each.end <= begin; });
    const std::size_t before = closed[static_cast<std::size_t>(gap - gaps.begin())];
    if (before > 0) view["byteOffset"] = begin - before;
  }
}

/// Takes parts out of a list. @return the new number of each, -1 of those taken out
std::vector<int> take_out(Json& list, const std::set<int>& left_over) {
  std::vector<int> numbers(list.size(), -1);
  Json kept = Json::array();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (left_over.contains(static_cast<int>(i))) continue;
    numbers[i] = static_cast<int>(kept.size());
    kept.push_back(std::move(list[i]));
  }
  list = std::move(kept);
  return numbers;
}

}  // namespace

References references_in(const GlbDraft& draft) {
  References references;
  references.accessors.resize(draft.accessors.size(), 0);
  references.views.resize(draft.views.size(), 0);
  const auto count = [&references](Part part, const Json& index, bool is_extra) {
    std::vector<int>& uses = part == Part::View ? references.views : references.accessors;
    const auto at = index.get<std::size_t>();
    if (at < uses.size()) ++uses[at];
    if (is_extra) references.are_all = false;
  };
  for (const Json* json : {&draft.json, &draft.accessors}) for_each_reference(*json, count);
  for (const Json* json : {&draft.json, &draft.accessors, &draft.views}) {
    if (has_unknown_extension(*json)) references.are_all = false;
  }
  return references;
}

bool release_view(GlbDraft& draft, References& references, std::size_t view) {
  if (view >= references.views.size() || --references.views[view] != 0) return false;
  if (!references.are_all) return true;
  draft.leftovers.bytes.push_back(bytes_of(draft.views[view]));
  draft.leftovers.views.insert(static_cast<int>(view));
  return true;
}

int release_views(GlbDraft& draft, References& references, const Json& accessor) {
  const auto release = [&](const Json& holder) {
    const auto view = holder.find("bufferView");
    if (view == holder.end()) return -1;
    const auto at = view->get<std::size_t>();
    return release_view(draft, references, at) ? static_cast<int>(at) : -1;
  };
  const auto sparse = accessor.find("sparse");
  if (sparse == accessor.end()) return release(accessor);
  for (const char* part : {"indices", "values"}) release(sparse->at(part));
  return release(accessor);
}

Released release_accessor(GlbDraft& draft, References& references, int accessor, int count) {
  int& left = references.accessors.at(static_cast<std::size_t>(accessor));
  left -= count;
  if (left != 0) return {};
  if (references.are_all) draft.leftovers.accessors.insert(accessor);
  return {true,
          release_views(draft, references, draft.accessors[static_cast<std::size_t>(accessor)])};
}

void keep_fields(const Json& from, Json& to) {
  for (const char* kept : {"name", "extensions", "extras"}) {
    if (from.contains(kept)) to[kept] = from[kept];
  }
}

int replace_view(GlbDraft& draft, References& references, int released, Json view) {
  int place = released;
  if (released < 0) {
    place = add_view(draft, std::move(view));
  } else {
    Json& old = draft.views[static_cast<std::size_t>(released)];
    keep_fields(old, view);
    old = std::move(view);
    draft.leftovers.views.erase(released);
  }
  references.views.resize(draft.views.size(), 0);
  references.views[static_cast<std::size_t>(place)] = 1;
  return place;
}

void remove_leftovers(GlbDraft& draft) {
  Leftovers& leftovers = draft.leftovers;
  if (!leftovers.views.empty() || !leftovers.accessors.empty()) {
    const std::vector<int> views = take_out(draft.views, leftovers.views);
    const std::vector<int> accessors = take_out(draft.accessors, leftovers.accessors);
    const auto renumber = [&](Part part, Json& index, bool is_extra) {
      const std::vector<int>& numbers = part == Part::View ? views : accessors;
      const auto at = index.get<std::size_t>();
      if (!is_extra && at < numbers.size()) index = static_cast<std::size_t>(numbers[at]);
    };
    for (Json* json : {&draft.json, &draft.accessors}) for_each_reference(*json, renumber);
  }
  close_gaps(draft, unseen_ranges(draft));
  leftovers = {};
}

}  // namespace morphbake
