#include "morphbake/gltf/replace_accessor.h"

#include <fmt/core.h>

#include <utility>

namespace morphbake {

int replace_accessor(GlbDraft& draft, References& references, const Replaced& old,
                     const NewNumbers& numbers) {
  const auto index = static_cast<std::size_t>(old.accessor);
  const Released released = release_accessor(draft, references, old.accessor, old.references);
  const std::size_t bytes =
      numbers.count * static_cast<std::size_t>(numbers.columns) * sizeof(float);
  const int view = replace_view(draft, references, released.view,
                                append_bytes(draft, numbers.data, bytes, numbers.use));
  const Json& source = draft.accessors[index];
  Json accessor = {
      {"bufferView", view},
      {"componentType", kFloatComponent},
      {"count", numbers.count},
      {"type", numbers.columns == 1 ? "SCALAR" : fmt::format("VEC{}", numbers.columns)}};
  if (source.contains("min")) {
    using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const Rows> rows(numbers.data, static_cast<Eigen::Index>(numbers.count),
                                      numbers.columns);
    accessor["min"] = column_minima(rows);
    accessor["max"] = column_maxima(rows);
  }
  if (!released.is_unused) return append_accessor(draft, std::move(accessor));
  keep_fields(source, accessor);
  draft.leftovers.accessors.erase(old.accessor);
  draft.accessors[index] = std::move(accessor);
  return old.accessor;
}

}  // namespace morphbake
