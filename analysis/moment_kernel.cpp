// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/moment_kernel.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "core/require.hpp"

namespace opponens::analysis {
namespace {

constexpr int kLanes = 8;               // partial sums of every total: row i adds to partial sum i mod 8
constexpr int kChunk = 64;              // rows centred at a time: they stay in the first-level cache
constexpr int kAheadRows = 2 * kChunk;  // fetched this long before they are needed
constexpr int kPageRows = 512;          // of one column, in a page of memory
constexpr int kTile = 4;                // columns of one register tile
constexpr int kTileSize = kTile * kTile * kLanes;
constexpr int kLineDoubles = 8;  // one cache line

/// A leaf's memory. Columns are padded with zeros to whole tiles.
struct Workspace {
  Eigen::Index columns;  // padded
  double* zeros;         // a column of a chunk
  double* copy;          // a chunk by column, as it came
  double* centred;       // a chunk by column, without the shift
  double* sums;          // [column][lane]
  double* products;      // of the lower triangle, [tile][4][4][lane]
};

/// A chunk that is short, or not stored by column, copied into the workspace. Rows that are missing hold the shift.
SampleView copied(const SampleView& chunk, const double* shift, const Workspace& work) {
  for (Eigen::Index j = 0; j < chunk.columns; ++j) {
    double* to = work.copy + j * kChunk;
    const double* from = chunk.data + j * chunk.column_stride;
    for (Eigen::Index i = 0; i < chunk.rows; ++i) to[i] = from[i * chunk.row_stride];
    std::fill(to + chunk.rows, to + kChunk, shift[j]);
  }
  return {work.copy, kChunk, chunk.columns, 1, kChunk};
}

/// W lanes at a time. Vectors are local to functions: passing them would depend on the instruction set.
template <int W>
struct Lanes {
  typedef double Vector __attribute__((vector_size(W * sizeof(double)), aligned(sizeof(double)), may_alias));
};

template <int W>
[[gnu::always_inline]] inline void load(typename Lanes<W>::Vector& to, const double* from) {
  to = *reinterpret_cast<const typename Lanes<W>::Vector*>(from);
}

template <int W>
[[gnu::always_inline]] inline void store(double* to, const typename Lanes<W>::Vector& from) {
  *reinterpret_cast<typename Lanes<W>::Vector*>(to) = from;
}

/// A place in memory that will be needed. It may lie behind the end of the samples, so it is no pointer.
using Address = std::uintptr_t;

Address address(const double* base, Eigen::Index offset) {
  return reinterpret_cast<Address>(base) + static_cast<Address>(offset) * sizeof(double);
}

[[gnu::always_inline]] inline void fetch(Address place) {
  __builtin_prefetch(reinterpret_cast<const void*>(place), 0, 2);
}

/// Columns of a chunk to come, fetched while the present one is worked on: two in each tile.
struct Ahead {
  Address first;
  Address second;
};

[[gnu::always_inline]] inline void fetch(const Ahead& ahead, int row) {
  fetch(ahead.first + static_cast<Address>(row) * sizeof(double));
  fetch(ahead.second + static_cast<Address>(row) * sizeof(double));
}

/// A tile on the diagonal. Writes x - shift of four columns of a chunk, adds it to their sums, and adds the products of
/// those columns with each other.
template <int W>
[[gnu::always_inline]] inline void diagonal_tile(const double* const (&from)[kTile], const double* shift, double* to,
                                                 double* sums, double* products, const Ahead& ahead) {
  using Vector = typename Lanes<W>::Vector;
  for (int lane = 0; lane < kLanes; lane += W) {
    Vector product[kTile][kTile];
    Vector sum[kTile];
#pragma GCC unroll 4
    for (int i = 0; i < kTile; ++i) {
      load<W>(sum[i], sums + i * kLanes + lane);
#pragma GCC unroll 4
      for (int j = 0; j <= i; ++j) load<W>(product[i][j], products + (i * kTile + j) * kLanes + lane);
    }
    for (int row = lane; row < kChunk; row += kLanes) {
      fetch(ahead, row - lane);
      Vector x[kTile];
#pragma GCC unroll 4
      for (int i = 0; i < kTile; ++i) {
        load<W>(x[i], from[i] + row);
        x[i] -= shift[i];
        store<W>(to + i * kChunk + row, x[i]);
        sum[i] += x[i];
#pragma GCC unroll 4
        for (int j = 0; j <= i; ++j) product[i][j] += x[i] * x[j];
      }
    }
#pragma GCC unroll 4
    for (int i = 0; i < kTile; ++i) {
      store<W>(sums + i * kLanes + lane, sum[i]);
#pragma GCC unroll 4
      for (int j = 0; j <= i; ++j) store<W>(products + (i * kTile + j) * kLanes + lane, product[i][j]);
    }
  }
}

/// A tile below the diagonal: adds the products of R centred columns from a with four from b, over a chunk.
template <int W, int R>
[[gnu::always_inline]] inline void lower_tile(const double* a, const double* b, double* products, const Ahead& ahead) {
  using Vector = typename Lanes<W>::Vector;
  for (int lane = 0; lane < kLanes; lane += W) {
    Vector product[R][kTile];
#pragma GCC unroll 4
    for (int i = 0; i < R; ++i) {
#pragma GCC unroll 4
      for (int j = 0; j < kTile; ++j) load<W>(product[i][j], products + (i * kTile + j) * kLanes + lane);
    }
    for (int row = lane; row < kChunk; row += kLanes) {
      fetch(ahead, row - lane);
      Vector right[kTile];
#pragma GCC unroll 4
      for (int j = 0; j < kTile; ++j) load<W>(right[j], b + j * kChunk + row);
#pragma GCC unroll 4
      for (int i = 0; i < R; ++i) {
        Vector left;
        load<W>(left, a + i * kChunk + row);
#pragma GCC unroll 4
        for (int j = 0; j < kTile; ++j) product[i][j] += left * right[j];
      }
    }
#pragma GCC unroll 4
    for (int i = 0; i < R; ++i) {
#pragma GCC unroll 4
      for (int j = 0; j < kTile; ++j) store<W>(products + (i * kTile + j) * kLanes + lane, product[i][j]);
    }
  }
}

/// Adds a chunk of whole columns; tiles in the order of the lower triangle.
template <int W, int R>
[[gnu::always_inline]] inline void sum_chunk(const SampleView& chunk, const double* shift, const Workspace& work) {
  double* products = work.products;
  Eigen::Index fetched = 0;
  const auto ahead = [&]() -> Ahead {
    const auto column = [&] {
      return address(chunk.data, std::min(fetched++, chunk.columns - 1) * chunk.column_stride + kAheadRows);
    };
    const Address first = column();
    return {first, column()};
  };
  for (Eigen::Index i = 0; i < work.columns; i += kTile) {
    double* a = work.centred + i * kChunk;
    double* const diagonal = products + i / kTile * kTileSize;
    const double* from[kTile];
    for (Eigen::Index k = 0; k < kTile; ++k) {
      from[k] = i + k < chunk.columns ? chunk.data + (i + k) * chunk.column_stride : work.zeros;
    }
    diagonal_tile<W>(from, shift + i, a, work.sums + i * kLanes, diagonal, ahead());
    for (Eigen::Index j = 0; j < i; j += kTile, products += kTileSize) {
      const double* b = work.centred + j * kChunk;
      for (int part = 0; part < kTile; part += R) {
        lower_tile<W, R>(a + part * kChunk, b, products + part * kTile * kLanes, ahead());
      }
    }
    products = diagonal + kTileSize;
  }
}

/// Sums over all chunks of a leaf. The next page of every column is touched in one go, since the processor translates
/// several addresses side by side but waits for each that comes alone. A chunk that is short, or not stored by column,
/// is copied first; its missing rows hold the shift, so they add nothing.
template <int W, int R>
[[gnu::always_inline]] inline void sum_leaf(const SampleView& leaf, const double* shift, const Workspace& work) {
  for (Eigen::Index row = 0; row < leaf.rows; row += kChunk) {
    SampleView chunk = leaf;
    chunk.data += row * leaf.row_stride;
    chunk.rows = std::min<Eigen::Index>(kChunk, leaf.rows - row);
    if (chunk.row_stride != 1 || chunk.rows != kChunk) {
      chunk = copied(chunk, shift, work);
    } else if (row % kPageRows == 0) {
      for (Eigen::Index j = 0; j < leaf.columns; ++j) fetch(address(chunk.data, j * leaf.column_stride + kPageRows));
    }
    sum_chunk<W, R>(chunk, shift, work);
  }
}

void sum_baseline(const SampleView& leaf, const double* shift, const Workspace& work) {
  sum_leaf<2, 2>(leaf, shift, work);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void sum_avx2(const SampleView& leaf, const double* shift, const Workspace& work) {
  sum_leaf<4, 2>(leaf, shift, work);
}

[[gnu::target("avx512f,prefer-vector-width=512")]] void sum_avx512(const SampleView& leaf, const double* shift,
                                                                   const Workspace& work) {
  sum_leaf<8, 4>(leaf, shift, work);
}
#endif

/// Eight partial sums in one fixed order.
double total(const double* lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

/// Mean of the first rows, relative to the first one.
Eigen::VectorXd shift_of(const SampleView& leaf, Eigen::Index padded) {
  const Eigen::Index rows = std::min<Eigen::Index>(kChunk, leaf.rows);
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(padded);
  for (Eigen::Index j = 0; j < leaf.columns; ++j) {
    const double* column = leaf.data + j * leaf.column_stride;
    double sum = 0.0;
    for (Eigen::Index i = 1; i < rows; ++i) sum += column[i * leaf.row_stride] - column[0];
    shift[j] = column[0] + sum / static_cast<double>(rows);
  }
  return shift;
}

void sum_leaf_at(SimdLevel level, const SampleView& leaf, const double* shift, const Workspace& work) {
#ifdef __x86_64__
  if (level == SimdLevel::avx512) return sum_avx512(leaf, shift, work);
  if (level == SimdLevel::avx2) return sum_avx2(leaf, shift, work);
#endif
  require(level == SimdLevel::baseline, "leaf_moments: this processor has no such instructions");
  sum_baseline(leaf, shift, work);
}

}  // namespace

std::vector<SimdLevel> simd_levels() {
  std::vector<SimdLevel> levels = {SimdLevel::baseline};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) levels.push_back(SimdLevel::avx2);
  if (__builtin_cpu_supports("avx512f")) levels.push_back(SimdLevel::avx512);
#endif
  return levels;
}

SampleStatistics leaf_moments(const SampleView& samples, const Eigen::VectorXd& origin, SimdLevel level) {
  require(samples.rows >= 1 && samples.rows <= kLeafRows && samples.columns >= 1 && origin.size() == samples.columns,
          "leaf_moments: rows, columns or origin");
  const Eigen::Index n = samples.columns;
  const Eigen::Index padded = (n + kTile - 1) / kTile * kTile;
  const Eigen::Index tiles = (padded / kTile) * (padded / kTile + 1) / 2;
  const Eigen::VectorXd shift = shift_of(samples, padded);
  // One allocation, aligned to a cache line.
  Eigen::VectorXd memory =
      Eigen::VectorXd::Zero(kLineDoubles + kChunk + padded * (2 * kChunk + kLanes) + tiles * kTileSize);
  const auto misaligned = static_cast<Eigen::Index>(address(memory.data(), 0) / sizeof(double) % kLineDoubles);
  double* next = memory.data() + (kLineDoubles - misaligned) % kLineDoubles;
  const auto take = [&next](Eigen::Index doubles) { return std::exchange(next, next + doubles); };
  const Workspace work{padded,
                       take(kChunk),
                       take(padded * kChunk),
                       take(padded * kChunk),
                       take(padded * kLanes),
                       take(tiles * kTileSize)};
  sum_leaf_at(level, samples, shift.data(), work);

  const auto rows = static_cast<double>(samples.rows);
  SampleStatistics result;
  result.count = rows;
  Eigen::VectorXd rest(n);  // mean of x - shift
  for (Eigen::Index j = 0; j < n; ++j) rest[j] = total(work.sums + j * kLanes) / rows;
  result.mean = (shift.head(n) - origin) + rest;
  result.covariance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Eigen::Index tile = (i / kTile) * (i / kTile + 1) / 2 + j / kTile;
      const Eigen::Index entry = (tile * kTile + i % kTile) * kTile + j % kTile;
      const double value = total(work.products + entry * kLanes) / rows - rest[i] * rest[j];
      result.covariance(i, j) = i == j ? std::max(value, 0.0) : value;
      result.covariance(j, i) = result.covariance(i, j);
    }
  }
  return result;
}

}  // namespace opponens::analysis
