#include "morphbake/gltf/displacements.h"

namespace morphbake {
namespace {

constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr double kMostMoving = 0.85;     // of vertices: where more move, sparse saves too little
constexpr double kSparseOverhead = 400;  // bytes of JSON and padding
constexpr std::size_t kVectorBytes = 3 * sizeof(float);

std::size_t index_bytes(std::uint32_t largest) {
  if (largest < 1U << 8U) return 1;
  return largest < 1U << 16U ? 2 : 4;
}

bool sparse_pays(const std::vector<std::uint32_t>& moving, Eigen::Index vertices) {
  const auto count = static_cast<double>(moving.size()), all = static_cast<double>(vertices);
  const auto bytes = static_cast<double>(kVectorBytes + index_bytes(moving.back()));
  return count <= kMostMoving * all && count * bytes + kSparseOverhead < all * kVectorBytes;
}

/// The fields of `sparse.indices`.
Json append_indices(GlbDraft& draft, const std::vector<std::uint32_t>& indices) {
  const std::size_t size = index_bytes(indices.back());
  std::string bytes;
  bytes.reserve(size * indices.size());
  for (const std::uint32_t index : indices) {
    for (std::size_t b = 0; b < size; ++b) bytes += static_cast<char>(index >> (8 * b) & 0xFFU);
  }
  const int view = append_view(draft, bytes.data(), bytes.size(), BufferUse::Other);
  const int component = size == 1 ? kUnsignedByte : size == 2 ? kUnsignedShort : kUnsignedInt;
  return {{"bufferView", view}, {"componentType", component}};
}

}  // namespace

std::vector<std::uint32_t> moving_rows(const Float3s& rows) {
  std::vector<std::uint32_t> moving;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    if (!rows.row(r).isZero(0)) moving.push_back(static_cast<std::uint32_t>(r));
  }
  return moving;
}

Json append_sparse_fields(GlbDraft& draft, const std::vector<std::uint32_t>& moving,
                          const void* values, std::size_t value_bytes) {
  Json indices = append_indices(draft, moving);
  const int view = append_view(draft, values, value_bytes, BufferUse::Other);
  return {{"count", moving.size()},
          {"indices", std::move(indices)},
          {"values", {{"bufferView", view}}}};
}

int Displacements::append(const Float3s& rows) {
  const std::vector<std::uint32_t> moving = moving_rows(rows);
  if (moving.empty()) return zeros(rows.rows(), "VEC3");
  if (may_be_sparse_ && sparse_pays(moving, rows.rows())) return append_sparse(moving, rows);
  return append_vectors(draft_, rows);
}

int Displacements::append_sparse(const std::vector<std::uint32_t>& moving, const Float3s& rows) {
  const Float3s values = rows(moving, Eigen::all);
  Json sparse = append_sparse_fields(draft_, moving, values.data(), moving.size() * kVectorBytes);
  return append_accessor(draft_, {{"componentType", kFloatComponent},
                                  {"count", rows.rows()},
                                  {"type", "VEC3"},
                                  {"min", column_minima(rows)},
                                  {"max", column_maxima(rows)},
                                  {"sparse", std::move(sparse)}});
}

int Displacements::zeros(Eigen::Index vertices, const std::string& type) {
  const auto [entry, is_new] = zeros_.try_emplace({vertices, type}, -1);
  if (is_new) entry->second = append_zeros(vertices, type);
  return entry->second;
}

/// Clients disagree about accessors without any bytes, so one of the zeros is told.
int Displacements::append_zeros(Eigen::Index vertices, const std::string& type) {
  Json accessor = {{"componentType", kFloatComponent}, {"count", vertices}, {"type", type}};
  if (type == "VEC3") accessor["min"] = accessor["max"] = {0.0, 0.0, 0.0};
  if (!may_be_sparse_) {
    const auto components = static_cast<std::size_t>(type.back() - '0');
    const std::vector<float> bytes(static_cast<std::size_t>(vertices) * components, 0.0F);
    accessor["bufferView"] =
        append_view(draft_, bytes.data(), bytes.size() * sizeof(float), BufferUse::Vertices);
    return append_accessor(draft_, std::move(accessor));
  }
  if (zero_index_ < 0) {
    constexpr unsigned char kFirst = 0;
    constexpr float kZeros[4] = {0, 0, 0, 0};
    zero_index_ = append_view(draft_, &kFirst, sizeof kFirst, BufferUse::Other);
    zero_value_ = append_view(draft_, kZeros, sizeof kZeros, BufferUse::Other);
  }
  accessor["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", zero_index_}, {"componentType", kUnsignedByte}}},
      {"values", {{"bufferView", zero_value_}}}};
  return append_accessor(draft_, std::move(accessor));
}

}  // namespace morphbake
