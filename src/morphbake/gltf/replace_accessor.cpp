#include "morphbake/gltf/replace_accessor.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace morphbake {
namespace {

void count(const Json& index, std::vector<int>& uses) {
  if (!index.is_number_unsigned()) return;
  const auto at = index.get<std::size_t>();
  if (at < uses.size()) ++uses[at];
}

void count_values(const Json& fields, std::vector<int>& uses) {
  if (!fields.is_object()) return;
  for (const auto& [name, index] : fields.items()) count(index, uses);
}

/// Visits each field of each object; nesting was bounded when the JSON was read.
template <typename Visit>
void for_each_field(const Json& json, const Visit& visit) {
  if (!json.is_structured()) return;
  for (const auto& [name, value] : json.items()) {
    if (json.is_object()) visit(std::string_view(name), value);
    for_each_field(value, visit);
  }
}

std::vector<int> accessor_uses(const GlbDraft& draft) {
  std::vector<int> uses(draft.accessors.size(), 0);
  constexpr std::array<std::string_view, 4> kSingle = {"indices", "input", "output",
                                                       "inverseBindMatrices"};
  for_each_field(draft.json, [&](std::string_view name, const Json& value) {
    if (name == "attributes") count_values(value, uses);
    if (name == "targets" && value.is_array()) {
      for (const Json& target : value) count_values(target, uses);
    }
    if (std::find(kSingle.begin(), kSingle.end(), name) != kSingle.end()) count(value, uses);
  });
  return uses;
}

std::vector<int> view_uses(const GlbDraft& draft) {
  std::vector<int> uses(draft.views.size(), 0);
  const auto visit = [&](std::string_view name, const Json& value) {
    if (name == "bufferView") count(value, uses);
  };
  for_each_field(draft.json, visit);
  for_each_field(draft.accessors, visit);
  return uses;
}

/// Fields that neither numbers nor their form depend on.
void keep_fields(const Json& from, Json& to) {
  for (const char* kept : {"name", "extensions", "extras"}) {
    if (from.contains(kept)) to[kept] = from[kept];
  }
}

/// The bufferView of new numbers: that of the old accessor when nothing else is in it.
int replace_view(GlbDraft& draft, const References& before, const Json& old_accessor,
                 const NewNumbers& numbers) {
  const std::size_t bytes =
      numbers.count * static_cast<std::size_t>(numbers.columns) * sizeof(float);
  const int added = append_view(draft, numbers.data, bytes, numbers.use);
  if (!old_accessor.contains("bufferView") || old_accessor.contains("sparse")) return added;
  const auto old = old_accessor["bufferView"].get<std::size_t>();
  if (old >= before.views.size() || before.views[old] != 1) return added;
  Json view = std::move(draft.views.back());
  draft.views.erase(draft.views.size() - 1);
  keep_fields(draft.views[old], view);
  draft.views[old] = std::move(view);
  return static_cast<int>(old);
}

}  // namespace

References references_in(const GlbDraft& draft) { return {accessor_uses(draft), view_uses(draft)}; }

int replace_accessor(GlbDraft& draft, const References& before, const Replaced& old,
                     const NewNumbers& numbers) {
  const auto index = static_cast<std::size_t>(old.accessor);
  const Json source = draft.accessors[index];
  const bool is_shared = before.accessors[index] > old.references;
  const int view = replace_view(draft, before, is_shared ? Json::object() : source, numbers);
  Json accessor = {{"bufferView", view},
                   {"componentType", kFloatComponent},
                   {"count", numbers.count},
                   {"type", numbers.columns == 1 ? "SCALAR" : "VEC3"}};
  if (source.contains("min")) {
    using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const Rows> rows(numbers.data, static_cast<Eigen::Index>(numbers.count),
                                      numbers.columns);
    accessor["min"] = column_minima(rows);
    accessor["max"] = column_maxima(rows);
  }
  if (is_shared) return append_accessor(draft, std::move(accessor));
  keep_fields(source, accessor);
  draft.accessors[index] = std::move(accessor);
  return old.accessor;
}

}  // namespace morphbake
