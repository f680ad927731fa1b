#include "morphbake/gltf/target_rows.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/document.h"
#include "morphbake/gltf/primitive_geometry.h"

namespace morphbake {

struct TargetRows::Source {
  Float3Rows rows;
  bool is_there = false;
  int accessor = -1;
  std::string pointer;
  Eigen::AlignedBox3f bounds;
  std::size_t first_bad = 0;  ///< row with a number that is not finite; the count when none is
};

namespace {

constexpr std::size_t kPart = 1024;  // rows: they stay in the cache

Float3Rows in_memory(const Float3s& rows) {
  Float3Rows lie;
  lie.first = reinterpret_cast<const unsigned char*>(rows.data());
  lie.stride = 3 * sizeof(float);
  lie.count = static_cast<std::size_t>(rows.rows());
  lie.component_type = TINYGLTF_COMPONENT_TYPE_FLOAT;
  return lie;
}

/// Finds the bounds of all rows, and the first one that is not finite.
template <typename Source>
void look_through(Source& source) {
  std::array<float, 3 * kPart> numbers;
  source.first_bad = source.rows.count;
  for (std::size_t begin = 0; begin < source.rows.count; begin += kPart) {
    const std::size_t count = std::min(kPart, source.rows.count - begin);
    read_part(source.rows, begin, count, numbers.data());
    using Part = Eigen::Map<const Eigen::Matrix3Xf>;
    const Part part(numbers.data(), 3, static_cast<Eigen::Index>(count));
    if ((part - part).sum() != 0) {  // NaN where one is not finite
      const auto* bad = std::ranges::find_if(numbers, [](float x) { return !std::isfinite(x); });
      source.first_bad = begin + static_cast<std::size_t>(bad - numbers.data()) / 3;
      return;
    }
    for (Eigen::Index v = 0; v < part.cols(); ++v) source.bounds.extend(part.col(v));
  }
}

}  // namespace

TargetRows::TargetRows(const GltfFile& file, int mesh)
    : file_(file), count_(target_count(*file, mesh)) {
  const auto& primitives = file->model.meshes[static_cast<std::size_t>(mesh)].primitives;
  std::vector<Source> sources;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const std::string pointer = primitive_pointer(mesh, p);
    const auto position = primitives[p].attributes.find("POSITION");
    const std::size_t vertices =
        position == primitives[p].attributes.end()
            ? 0
            : accessor_count(*file, position->second, pointer + "/attributes/POSITION");
    for (std::size_t t = 0; t < count_; ++t) {
      const std::string place = fmt::format("{}/targets/{}", pointer, t);
      for (const auto& [name, accessor] : primitives[p].targets[t]) {
        check_count(*file, accessor, vertices, fmt::format("{}/{}", place, name));
      }
      for (const char* name : {"POSITION", "NORMAL"}) {
        Source& source = sources.emplace_back();
        const auto found = primitives[p].targets[t].find(name);
        if (found == primitives[p].targets[t].end()) continue;
        source.is_there = true;
        source.accessor = found->second;
        source.pointer = fmt::format("{}/{}", place, name);
        source.rows = open_float3s(*file, found->second, source.pointer);
      }
    }
  }
  tbb::parallel_for(std::size_t{0}, sources.size(),
                    [&](std::size_t i) { look_through(sources[i]); });
  for (const Source& source : sources) {
    if (source.first_bad == source.rows.count) continue;
    fail_at(*file, source.pointer, "gltf.not-finite",
            fmt::format("element {} of accessor {} is not a finite number", source.first_bad,
                        source.accessor));
  }
  sources_ = std::make_shared<const std::vector<Source>>(std::move(sources));
}

TargetRows::TargetRows(const AnimatedMesh& mesh) : count_(mesh.target_names.size()) {
  std::vector<Source> sources;
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    for (std::size_t t = 0; t < count_; ++t) {
      for (const auto* targets : {&primitive.target_positions, &primitive.target_normals}) {
        Source& source = sources.emplace_back();
        if (t >= targets->size() || (*targets)[t].rows() == 0) continue;
        source.is_there = true;
        source.rows = in_memory((*targets)[t]);
        look_through(source);
      }
    }
  }
  sources_ = std::make_shared<const std::vector<Source>>(std::move(sources));
}

const TargetRows::Source& TargetRows::source_at(const TargetPlace& place) const {
  const std::size_t attribute = place.attribute == MorphedAttribute::Normal ? 1 : 0;
  const std::size_t index = 2 * (place.primitive * count_ + place.target) + attribute;
  assert(place.target < count_ && index < sources_->size());
  return (*sources_)[index];
}

bool TargetRows::has(const TargetPlace& place) const { return source_at(place).is_there; }

const Eigen::AlignedBox3f& TargetRows::bounds(std::size_t primitive, std::size_t target) const {
  return source_at({primitive, target, MorphedAttribute::Position}).bounds;
}

void TargetRows::read(const TargetPlace& place, Eigen::Index begin, Eigen::Index count,
                      float* out) const {
  read_part(source_at(place).rows, static_cast<std::size_t>(begin), static_cast<std::size_t>(count),
            out);
}

}  // namespace morphbake
