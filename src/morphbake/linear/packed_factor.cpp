#include "morphbake/linear/packed_factor.h"

#include <algorithm>

namespace morphbake {
namespace {

constexpr int kTile = 4;  // rows
constexpr int kTriangle = kTile * kTile;
constexpr int kBlockVectors = 3;                 // a row: twelve of sixteen registers hold a tile
constexpr int kMostVectors = 2 * kBlockVectors;  // a row: the factor is read once for both halves
constexpr int kVectorBytes = 32;

template <class Scalar>
constexpr int kLanes = kVectorBytes / static_cast<int>(sizeof(Scalar));

/// One row of a panel of N vectors.
template <class Scalar, int N>
struct alignas(kVectorBytes) Row {
  typedef Scalar Vector __attribute__((vector_size(kVectorBytes)));  // "using" knows no such type
  Vector vectors[N];
};

/// What a substitution reads.
template <class Scalar>
struct Packed {
  std::span<const PackedSupernode> supernodes;
  const int* rows = nullptr;
  const Scalar* values = nullptr;
};

// Everything below is inlined into functions for one kind of machine each. No multiplication is
// fused with an addition, so that all give the same bytes.
#define MORPHBAKE_INLINE [[gnu::always_inline]] inline

/// to[rows] -= L from[0 .. columns)
template <class Scalar, int N>
MORPHBAKE_INLINE void subtract_from_rows(const Scalar* L, int columns, const Row<Scalar, N>* from,
                                         const int* rows, Row<Scalar, N>* y) {
  constexpr int kBlock = N < kBlockVectors ? N : kBlockVectors;
  for (int first = 0; first < N; first += kBlock) {
    typename Row<Scalar, N>::Vector sums[kTile][kBlock];
    for (int i = 0; i < kTile; ++i) {
      for (int n = 0; n < kBlock; ++n) sums[i][n] = y[rows[i]].vectors[first + n];
    }
    for (int k = 0; k < columns; ++k) {
      for (int i = 0; i < kTile; ++i) {
        for (int n = 0; n < kBlock; ++n)
          sums[i][n] -= L[kTile * k + i] * from[k].vectors[first + n];
      }
    }
    for (int i = 0; i < kTile; ++i) {
      for (int n = 0; n < kBlock; ++n) y[rows[i]].vectors[first + n] = sums[i][n];
    }
  }
}

/// to[0 .. columns) -= L^T y[rows]
template <class Scalar, int N>
MORPHBAKE_INLINE void subtract_from_columns(const Scalar* L, int columns, const int* rows,
                                            const Row<Scalar, N>* y, Row<Scalar, N>* to) {
  constexpr int kBlock = N < kBlockVectors ? N : kBlockVectors;
  for (int first = 0; first < N; first += kBlock) {
    typename Row<Scalar, N>::Vector below[kTile][kBlock];
    for (int i = 0; i < kTile; ++i) {
      for (int n = 0; n < kBlock; ++n) below[i][n] = y[rows[i]].vectors[first + n];
    }
    for (int k = 0; k < columns; ++k) {
      for (int n = 0; n < kBlock; ++n) {
        auto sum = to[k].vectors[first + n];
        for (int i = 0; i < kTile; ++i) sum -= L[kTile * k + i] * below[i][n];
        to[k].vectors[first + n] = sum;
      }
    }
  }
}

/// The triangle's tile on the diagonal, which holds the inverse of each diagonal entry.
template <class Scalar, int N>
MORPHBAKE_INLINE void solve_triangle(const Scalar* D, const int* rows, Row<Scalar, N>* y) {
  for (int i = 0; i < kTile; ++i) {
    for (int n = 0; n < N; ++n) {
      auto sum = y[rows[i]].vectors[n];
      for (int j = 0; j < i; ++j) sum -= D[kTile * i + j] * y[rows[j]].vectors[n];
      y[rows[i]].vectors[n] = sum * D[(kTile + 1) * i];
    }
  }
}

template <class Scalar, int N>
MORPHBAKE_INLINE void solve_transposed_triangle(const Scalar* D, const int* rows,
                                                Row<Scalar, N>* y) {
  for (int i = kTile; i-- > 0;) {
    for (int n = 0; n < N; ++n) {
      auto sum = y[rows[i]].vectors[n];
      for (int j = i + 1; j < kTile; ++j) sum -= D[kTile * j + i] * y[rows[j]].vectors[n];
      y[rows[i]].vectors[n] = sum * D[(kTile + 1) * i];
    }
  }
}

/// Values of a triangle's tiles before the one of index `tile`.
constexpr std::size_t values_before(std::size_t tile) {
  return static_cast<std::size_t>(kTriangle) * (tile * (tile + 1) / 2);
}

template <class Scalar, int N>
MORPHBAKE_INLINE void forward(const Packed<Scalar>& packed, Row<Scalar, N>* y) {
  for (const PackedSupernode& node : packed.supernodes) {
    const Scalar* values = packed.values + node.first_value;
    const int* rows = packed.rows + kTile * node.first_tile;
    for (int tile = 0; tile < node.tiles; ++tile, rows += kTile) {
      const int columns = kTile * std::min(tile, node.triangle_tiles);
      subtract_from_rows<Scalar, N>(values, columns, y + node.first_column, rows, y);
      values += kTile * columns;
      if (tile >= node.triangle_tiles) continue;
      solve_triangle<Scalar, N>(values, rows, y);
      values += kTriangle;
    }
  }
}

template <class Scalar, int N>
MORPHBAKE_INLINE void backward(const Packed<Scalar>& packed, Row<Scalar, N>* y) {
  for (auto node = packed.supernodes.rbegin(); node != packed.supernodes.rend(); ++node) {
    const int* rows = packed.rows + kTile * node->first_tile;
    const int all = kTile * node->triangle_tiles;
    const Scalar* triangle = packed.values + node->first_value;
    const Scalar* values = triangle + values_before(static_cast<std::size_t>(node->triangle_tiles));
    Row<Scalar, N>* own = y + node->first_column;
    for (int tile = node->triangle_tiles; tile < node->tiles; ++tile, values += kTile * all) {
      subtract_from_columns<Scalar, N>(values, all, rows + kTile * tile, y, own);
    }
    for (int tile = node->triangle_tiles; tile-- > 0;) {
      values = triangle + values_before(static_cast<std::size_t>(tile));
      solve_transposed_triangle<Scalar, N>(values + kTriangle * tile, rows + kTile * tile, y);
      subtract_from_columns<Scalar, N>(values, kTile * tile, rows + kTile * tile, y, own);
    }
  }
}

#undef MORPHBAKE_INLINE

template <class Scalar, int N>
void substitute_anywhere(const Packed<Scalar>& packed, Row<Scalar, N>* y) {
  forward<Scalar, N>(packed, y);
  backward<Scalar, N>(packed, y);
}

#ifdef __x86_64__
template <class Scalar, int N>
[[gnu::target("avx2")]] void substitute_avx2(const Packed<Scalar>& packed, Row<Scalar, N>* y) {
  forward<Scalar, N>(packed, y);
  backward<Scalar, N>(packed, y);
}
#endif

/// y <- L^-T L^-1 y
template <class Scalar, int N>
void substitute(const Packed<Scalar>& packed, Row<Scalar, N>* y) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return substitute_avx2<Scalar, N>(packed, y);
#endif
  substitute_anywhere<Scalar, N>(packed, y);
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
  values_.assign(values, Scalar(0));
  for (std::size_t s = 0; s < count; ++s) pack(factor, s);
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
          factor.rows[static_cast<std::size_t>(factor.row_start[supernode] + row)];
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

/// Right-hand sides, and solutions in their place.
template <class Scalar>
struct PackedFactor<Scalar>::Columns {
  double* first = nullptr;
  Eigen::Index count = 0;
  Eigen::Index row_stride = 0, column_stride = 0;
};

template <class Scalar>
template <int N>
void PackedFactor<Scalar>::solve_panels(const Columns& columns, Eigen::Index first,
                                        Eigen::Index last) const {
  constexpr int kWidth = N * kLanes<Scalar>;
  // A supernode's last tile may reach beyond its columns, and the last one beyond all of them.
  std::vector<Row<Scalar, N>> y(factored_rows_ + kTile);
  const Eigen::Index stride = columns.column_stride;
  for (Eigen::Index begin = first; begin < last; begin += kWidth) {
    const Eigen::Index width = std::min<Eigen::Index>(kWidth, last - begin);
    double* const panel = columns.first + begin * stride;
    for (std::size_t row = 0; row < place_.size(); ++row) {
      if (place_[row] < 0) continue;
      Row<Scalar, N>& to = y[static_cast<std::size_t>(place_[row])];
      const double* from = panel + columns.row_stride * static_cast<Eigen::Index>(row);
      for (Eigen::Index c = 0; c < width; ++c, from += stride) {
        to.vectors[c / kLanes<Scalar>][c % kLanes<Scalar>] = static_cast<Scalar>(*from);
      }
    }
    substitute<Scalar, N>({supernodes_, rows_.data(), values_.data()}, y.data());
    for (std::size_t row = 0; row < place_.size(); ++row) {
      double* to = panel + columns.row_stride * static_cast<Eigen::Index>(row);
      if (place_[row] < 0) {
        for (Eigen::Index c = 0; c < width; ++c, to += stride) *to = 0;
        continue;
      }
      const Row<Scalar, N>& from = y[static_cast<std::size_t>(place_[row])];
      for (Eigen::Index c = 0; c < width; ++c, to += stride) {
        *to = from.vectors[c / kLanes<Scalar>][c % kLanes<Scalar>];
      }
    }
  }
}

template <class Scalar>
void PackedFactor<Scalar>::solve_all(const Columns& columns) const {
  constexpr Eigen::Index kWidest = kMostVectors * kLanes<Scalar>;
  const Eigen::Index whole = columns.count / kWidest * kWidest, left = columns.count - whole;
  if (whole > 0) solve_panels<kMostVectors>(columns, 0, whole);
  if (left > 3 * kLanes<Scalar>) {
    solve_panels<6>(columns, whole, columns.count);
  } else if (left > 2 * kLanes<Scalar>) {
    solve_panels<3>(columns, whole, columns.count);
  } else if (left > kLanes<Scalar>) {
    solve_panels<2>(columns, whole, columns.count);
  } else if (left > 0) {
    solve_panels<1>(columns, whole, columns.count);
  }
}

template <class Scalar>
Eigen::MatrixXd PackedFactor<Scalar>::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  solve_all({x.data(), x.cols(), 1, x.rows()});
  return x;
}

template <class Scalar>
void PackedFactor<Scalar>::solve_in_place(ColumnRows& columns) const {
  solve_all({columns.data(), columns.cols(), columns.cols(), 1});
}

template <class Scalar>
std::size_t PackedFactor<Scalar>::bytes() const {
  return values_.size() * sizeof(Scalar) + rows_.size() * sizeof(int);
}

template class PackedFactor<double>;
template class PackedFactor<float>;

}  // namespace morphbake
