#include "morphbake/linear/packed_factor.h"

#include <algorithm>

namespace morphbake {
namespace {

constexpr int kTile = 4;  // rows
constexpr int kTriangle = kTile * kTile;
constexpr int kLeastBytes = 32;   // of a vector
constexpr int kWidestPanel = 6;   // such vectors a row
constexpr int kBlockVectors = 3;  // a row: twelve of sixteen registers hold a tile

template <class Scalar>
constexpr int kLeastLanes = kLeastBytes / static_cast<int>(sizeof(Scalar));

/// One row of a panel of columns.
template <class Scalar, int Columns>
struct alignas(Columns * sizeof(Scalar) % 64 == 0 ? 64 : kLeastBytes) Row {
  Scalar columns[Columns];
};

/// Some columns of a row, which one instruction takes.
template <class S, int Bytes>
struct VectorOf {
  using Scalar = S;
  typedef S Type __attribute__((vector_size(Bytes), may_alias));  // "using" knows no such type
};

/// What a substitution reads.
template <class Scalar>
struct Packed {
  std::span<const PackedSupernode> supernodes;
  const int* rows = nullptr;
  const Scalar* values = nullptr;
};

// Everything below is inlined into functions for one kind of machine each. No multiplication is
// fused with an addition, so that all give the same bytes. A panel y has N vectors a row.
#define MORPHBAKE_INLINE [[gnu::always_inline]] inline

/// y[rows] -= L from[0 .. columns)
template <class Vector, int N>
MORPHBAKE_INLINE void subtract_from_rows(const typename Vector::Scalar* L, int columns,
                                         const typename Vector::Type* from, const int* rows,
                                         typename Vector::Type* y) {
  constexpr int kBlock = N < kBlockVectors ? N : kBlockVectors;
  for (int first = 0; first < N; first += kBlock) {
    typename Vector::Type sums[kTile][kBlock];
    for (int i = 0; i < kTile; ++i) {
      for (int n = 0; n < kBlock; ++n) sums[i][n] = y[N * rows[i] + first + n];
    }
    for (int k = 0; k < columns; ++k) {
      for (int i = 0; i < kTile; ++i) {
        for (int n = 0; n < kBlock; ++n) sums[i][n] -= L[kTile * k + i] * from[N * k + first + n];
      }
    }
    for (int i = 0; i < kTile; ++i) {
      for (int n = 0; n < kBlock; ++n) y[N * rows[i] + first + n] = sums[i][n];
    }
  }
}

/// to[0 .. columns) -= L^T y[rows]
template <class Vector, int N>
MORPHBAKE_INLINE void subtract_from_columns(const typename Vector::Scalar* L, int columns,
                                            const int* rows, const typename Vector::Type* y,
                                            typename Vector::Type* to) {
  constexpr int kBlock = N < kBlockVectors ? N : kBlockVectors;
  for (int first = 0; first < N; first += kBlock) {
    typename Vector::Type below[kTile][kBlock];
    for (int i = 0; i < kTile; ++i) {
      for (int n = 0; n < kBlock; ++n) below[i][n] = y[N * rows[i] + first + n];
    }
    for (int k = 0; k < columns; ++k) {
      for (int n = 0; n < kBlock; ++n) {
        auto sum = to[N * k + first + n];
        for (int i = 0; i < kTile; ++i) sum -= L[kTile * k + i] * below[i][n];
        to[N * k + first + n] = sum;
      }
    }
  }
}

/// The triangle's tile on the diagonal, which holds the inverse of each diagonal entry.
template <class Vector, int N>
MORPHBAKE_INLINE void solve_triangle(const typename Vector::Scalar* tile, const int* rows,
                                     typename Vector::Type* y) {
  for (int i = 0; i < kTile; ++i) {
    for (int n = 0; n < N; ++n) {
      auto sum = y[N * rows[i] + n];
      for (int j = 0; j < i; ++j) sum -= tile[kTile * i + j] * y[N * rows[j] + n];
      y[N * rows[i] + n] = sum * tile[(kTile + 1) * i];
    }
  }
}

template <class Vector, int N>
MORPHBAKE_INLINE void solve_transposed_triangle(const typename Vector::Scalar* tile,
                                                const int* rows, typename Vector::Type* y) {
  for (int i = kTile; i-- > 0;) {
    for (int n = 0; n < N; ++n) {
      auto sum = y[N * rows[i] + n];
      for (int j = i + 1; j < kTile; ++j) sum -= tile[kTile * j + i] * y[N * rows[j] + n];
      y[N * rows[i] + n] = sum * tile[(kTile + 1) * i];
    }
  }
}

/// Values of a triangle's tiles before the one of index `tile`.
constexpr std::size_t values_before(std::size_t tile) {
  return static_cast<std::size_t>(kTriangle) * (tile * (tile + 1) / 2);
}

template <class Vector, int N>
MORPHBAKE_INLINE void forward(const Packed<typename Vector::Scalar>& packed,
                              typename Vector::Type* y) {
  for (const PackedSupernode& node : packed.supernodes) {
    const auto* values = packed.values + node.first_value;
    const int* rows = packed.rows + kTile * node.first_tile;
    for (int tile = 0; tile < node.tiles; ++tile, rows += kTile) {
      const int columns = kTile * std::min(tile, node.triangle_tiles);
      subtract_from_rows<Vector, N>(values, columns, y + N * node.first_column, rows, y);
      values += kTile * columns;
      if (tile >= node.triangle_tiles) continue;
      solve_triangle<Vector, N>(values, rows, y);
      values += kTriangle;
    }
  }
}

template <class Vector, int N>
MORPHBAKE_INLINE void backward(const Packed<typename Vector::Scalar>& packed,
                               typename Vector::Type* y) {
  for (auto node = packed.supernodes.rbegin(); node != packed.supernodes.rend(); ++node) {
    const int* rows = packed.rows + kTile * node->first_tile;
    const int all = kTile * node->triangle_tiles;
    const auto* triangle = packed.values + node->first_value;
    const auto* values = triangle + values_before(static_cast<std::size_t>(node->triangle_tiles));
    auto* own = y + N * node->first_column;
    for (int tile = node->triangle_tiles; tile < node->tiles; ++tile, values += kTile * all) {
      subtract_from_columns<Vector, N>(values, all, rows + kTile * tile, y, own);
    }
    for (int tile = node->triangle_tiles; tile-- > 0;) {
      values = triangle + values_before(static_cast<std::size_t>(tile));
      solve_transposed_triangle<Vector, N>(values + kTriangle * tile, rows + kTile * tile, y);
      subtract_from_columns<Vector, N>(values, kTile * tile, rows + kTile * tile, y, own);
    }
  }
}

/// y <- L^-T L^-1 y, by vectors of some bytes.
template <int Bytes, class Scalar, int Columns>
MORPHBAKE_INLINE void substitute_by(const Packed<Scalar>& packed, Row<Scalar, Columns>* y) {
  using Vector = VectorOf<Scalar, Bytes>;
  constexpr int kVectors = Columns * static_cast<int>(sizeof(Scalar)) / Bytes;
  auto* vectors = reinterpret_cast<typename Vector::Type*>(y);
  forward<Vector, kVectors>(packed, vectors);
  backward<Vector, kVectors>(packed, vectors);
}

#undef MORPHBAKE_INLINE

#ifdef __x86_64__
template <class Scalar, int Columns>
[[gnu::target("avx512f")]] void substitute_avx512(const Packed<Scalar>& packed,
                                                  Row<Scalar, Columns>* y) {
  substitute_by<2 * kLeastBytes>(packed, y);
}

template <class Scalar, int Columns>
[[gnu::target("avx2")]] void substitute_avx2(const Packed<Scalar>& packed,
                                             Row<Scalar, Columns>* y) {
  substitute_by<kLeastBytes>(packed, y);
}
#endif

/// y <- L^-T L^-1 y
template <class Scalar, int Columns>
void substitute(const Packed<Scalar>& packed, Row<Scalar, Columns>* y) {
#ifdef __x86_64__
  if constexpr (Columns * sizeof(Scalar) % (2 * kLeastBytes) == 0) {
    if (__builtin_cpu_supports("avx512f")) return substitute_avx512(packed, y);
  }
  if (__builtin_cpu_supports("avx2")) return substitute_avx2(packed, y);
#endif
  substitute_by<kLeastBytes>(packed, y);
}

}  // namespace

template <class Scalar>
PackedFactor<Scalar>::PackedFactor(const SupernodalFactor& factor)
    : place_(factor.row_count, -1), factored_rows_(factor.order.size()) {
  for (std::size_t row = 0; row < factored_rows_; ++row) {
    place_[static_cast<std::size_t>(factor.order[row])] = static_cast<int>(row);
  }
  const std::size_t count = factor.first_column.size() - 1;
  std::size_t tiles = 0, values = 0;
  for (std::size_t s = 0; s < count; ++s) {
    const int columns = factor.first_column[s + 1] - factor.first_column[s];
    const int below = factor.row_start[s + 1] - factor.row_start[s] - columns;
    PackedSupernode node;
    node.first_column = factor.first_column[s];
    node.triangle_tiles = (columns + kTile - 1) / kTile;
    node.tiles = node.triangle_tiles + (below + kTile - 1) / kTile;
    node.first_tile = tiles;
    node.first_value = values;
    const auto own = static_cast<std::size_t>(node.triangle_tiles);
    tiles += static_cast<std::size_t>(node.tiles);
    values += values_before(own) + kTriangle * own * (static_cast<std::size_t>(node.tiles) - own);
    supernodes_.push_back(node);
  }
  rows_.assign(kTile * tiles, static_cast<int>(factored_rows_));
  values_.reserve(values);  // memory that is not touched before it is filled
  for (std::size_t s = 0; s < count; ++s) {
    values_.resize(s + 1 < count ? supernodes_[s + 1].first_value : values, Scalar(0));
    pack(factor, s);
    factor.on_packed(static_cast<std::size_t>(factor.value_start[s + 1]));
  }
}

template <class Scalar>
void PackedFactor<Scalar>::pack(const SupernodalFactor& factor, std::size_t supernode) {
  const PackedSupernode& node = supernodes_[supernode];
  const int columns = factor.first_column[supernode + 1] - factor.first_column[supernode];
  const int row_count = factor.row_start[supernode + 1] - factor.row_start[supernode];
  const double* L = factor.values + factor.value_start[supernode];
  Scalar* to = values_.data() + node.first_value;
  for (int tile = 0; tile < node.tiles; ++tile) {
    const bool is_triangle = tile < node.triangle_tiles;
    const int first_row =
        is_triangle ? kTile * tile : columns + kTile * (tile - node.triangle_tiles);
    const int last_row = std::min(first_row + kTile, is_triangle ? columns : row_count);
    const int left = kTile * std::min(tile, node.triangle_tiles);
    for (int row = first_row; row < last_row; ++row) {
      const auto value = [&](int column) {
        return static_cast<Scalar>(
            L[static_cast<std::size_t>(column) * static_cast<std::size_t>(row_count) +
              static_cast<std::size_t>(row)]);
      };
      const int i = row - first_row;
      rows_[kTile * (node.first_tile + static_cast<std::size_t>(tile)) +
            static_cast<std::size_t>(i)] =
          factor.rows[static_cast<std::size_t>(factor.row_start[supernode]) +
                      static_cast<std::size_t>(row)];
      for (int column = 0; column < std::min(left, columns); ++column) {
        to[kTile * column + i] = value(column);
      }
      if (!is_triangle) continue;
      for (int j = 0; j < i; ++j) to[kTile * (left + i) + j] = value(left + j);
      to[kTile * (left + i) + i] = 1 / value(row);
    }
    to += kTile * left + (is_triangle ? kTriangle : 0);
  }
}

template <class Scalar>
template <int Vectors>
void PackedFactor<Scalar>::solve_panels(ColumnRows& columns, Eigen::Index first,
                                        Eigen::Index last) const {
  constexpr int kWidth = Vectors * kLeastLanes<Scalar>;
  // A supernode's last tile may reach beyond its columns, and the last one beyond all of them.
  std::vector<Row<Scalar, kWidth>> y(factored_rows_ + kTile);
  for (Eigen::Index begin = first; begin < last; begin += kWidth) {
    const Eigen::Index width = std::min<Eigen::Index>(kWidth, last - begin);
    for (std::size_t row = 0; row < place_.size(); ++row) {
      if (place_[row] < 0) continue;
      const double* from = &columns(static_cast<Eigen::Index>(row), begin);
      Scalar* to = y[static_cast<std::size_t>(place_[row])].columns;
      for (Eigen::Index c = 0; c < width; ++c) to[c] = static_cast<Scalar>(from[c]);
    }
    substitute<Scalar, kWidth>({supernodes_, rows_.data(), values_.data()}, y.data());
    for (std::size_t row = 0; row < place_.size(); ++row) {
      double* to = &columns(static_cast<Eigen::Index>(row), begin);
      if (place_[row] < 0) {
        std::fill_n(to, width, 0.0);
      } else {
        std::copy_n(y[static_cast<std::size_t>(place_[row])].columns, width, to);
      }
    }
  }
}

template <class Scalar>
void PackedFactor<Scalar>::solve_in_place(ColumnRows& columns) const {
  constexpr Eigen::Index kLanes = kLeastLanes<Scalar>;
  const Eigen::Index count = columns.cols(), left = count % (kWidestPanel * kLanes);
  const Eigen::Index whole = count - left;
  if (whole > 0) solve_panels<kWidestPanel>(columns, 0, whole);
  if (left > 3 * kLanes) {
    solve_panels<kWidestPanel>(columns, whole, count);
  } else if (left > 2 * kLanes) {
    solve_panels<3>(columns, whole, count);
  } else if (left > kLanes) {
    solve_panels<2>(columns, whole, count);
  } else if (left > 0) {
    solve_panels<1>(columns, whole, count);
  }
}

template <class Scalar>
Eigen::MatrixXd PackedFactor<Scalar>::solve(const Eigen::MatrixXd& b) const {
  ColumnRows x = b;
  solve_in_place(x);
  return x;
}

template <class Scalar>
std::size_t PackedFactor<Scalar>::bytes() const {
  return values_.size() * sizeof(Scalar) + rows_.size() * sizeof(int);
}

template class PackedFactor<double>;
template class PackedFactor<float>;

}  // namespace morphbake
