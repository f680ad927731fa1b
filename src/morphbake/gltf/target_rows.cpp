#include "morphbake/gltf/target_rows.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/document.h"
#include "morphbake/gltf/primitive_geometry.h"

namespace morphbake {

/// Where one attribute of one target lies.
struct TargetSource {
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
void look_through(TargetSource& source) {
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

TargetSource source_in_file(const GltfDocument& document, const std::map<std::string, int>& target,
                            const std::string& name, const std::string& pointer) {
  const auto found = target.find(name);
  if (found == target.end()) return {};
  TargetSource source;
  source.is_there = true;
  source.accessor = found->second;
  source.pointer = pointer + "/" + name;
  source.rows = open_float3s(document, found->second, source.pointer);
  return source;
}

/// Appends the targets of a primitive: position and normal of each.
void append_sources(const GltfDocument& document, const tinygltf::Primitive& primitive,
                    const std::string& pointer, std::vector<TargetSource>& sources) {
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) {
    fail_at(document, pointer + "/attributes", "gltf.unsupported-primitive",
            "the primitive has no POSITION");
  }
  const std::size_t vertices =
      accessor_count(document, position->second, pointer + "/attributes/POSITION");
  for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
    const std::string place = fmt::format("{}/targets/{}", pointer, t);
    for (const auto& [name, accessor] : primitive.targets[t]) {
      check_count(document, accessor, vertices, fmt::format("{}/{}", place, name));
    }
    for (const char* name : {"POSITION", "NORMAL"}) {
      sources.push_back(source_in_file(document, primitive.targets[t], name, place));
    }
  }
}

void check_finite(const GltfDocument& document, const std::vector<TargetSource>& sources) {
  for (const TargetSource& source : sources) {
    if (source.first_bad == source.rows.count) continue;
    fail_at(document, source.pointer, "gltf.not-finite",
            fmt::format("element {} of accessor {} is not a finite number", source.first_bad,
                        source.accessor));
  }
}

}  // namespace

TargetRows::TargetRows(const GltfFile& file, int mesh)
    : file_(file), count_(target_count(*file, mesh)) {
  const auto& primitives = file->model.meshes[static_cast<std::size_t>(mesh)].primitives;
  std::vector<TargetSource> sources;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    append_sources(*file, primitives[p], primitive_pointer(mesh, p), sources);
  }
  tbb::parallel_for(std::size_t{0}, sources.size(),
                    [&](std::size_t i) { look_through(sources[i]); });
  check_finite(*file, sources);
  sources_ = std::make_shared<const std::vector<TargetSource>>(std::move(sources));
}

TargetRows::TargetRows(const AnimatedMesh& mesh) : count_(mesh.target_names.size()) {
  std::vector<TargetSource> sources;
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    for (std::size_t t = 0; t < count_; ++t) {
      for (const auto* targets : {&primitive.target_positions, &primitive.target_normals}) {
        TargetSource& source = sources.emplace_back();
        if (t >= targets->size() || (*targets)[t].rows() == 0) continue;
        source.is_there = true;
        source.rows = in_memory((*targets)[t]);
        look_through(source);
      }
    }
  }
  sources_ = std::make_shared<const std::vector<TargetSource>>(std::move(sources));
}

const TargetSource& TargetRows::source_at(const TargetPlace& place) const {
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
