#pragma once

#include "sim/core/parallel.h"
#include "sim/grid/block_grid.h"

#include <bit>
#include <cmath>
#include <cstdint>

// A block is 64 rows of 8 cells along x; row r = 8 k + j. The solver's loops go row by row, one vector each.

namespace sim {

inline constexpr int kBlockRows = kBlockEdge * kBlockEdge;

namespace detail {
template <class T>
struct RowOf {
    typedef T Type __attribute__((vector_size(kBlockEdge * sizeof(T))));
};
}  // namespace detail

/// Eight cells side by side.
template <class T>
using Row = typename detail::RowOf<T>::Type;

template <class T>
inline Row<T> loadRow(const T* p)
{
    Row<T> row;
    __builtin_memcpy(&row, __builtin_assume_aligned(p, sizeof(row)), sizeof(row));
    return row;
}

template <class T>
inline Row<T> loadUnalignedRow(const T* p)
{
    Row<T> row;
    __builtin_memcpy(&row, p, sizeof(row));
    return row;
}

template <class T>
inline void storeRow(T* p, Row<T> row)
{
    __builtin_memcpy(__builtin_assume_aligned(p, sizeof(row)), &row, sizeof(row));
}

/// The cells one lower along x; the first is given.
template <class T>
inline Row<T> lowerAlongX(Row<T> row, T first)
{
    const Row<T> f = first - Row<T>{};
    return __builtin_shufflevector(row, f, 8, 0, 1, 2, 3, 4, 5, 6);
}

/// The cells one higher along x; the last is given.
template <class T>
inline Row<T> upperAlongX(Row<T> row, T last)
{
    const Row<T> l = last - Row<T>{};
    return __builtin_shufflevector(row, l, 1, 2, 3, 4, 5, 6, 7, 8);
}

template <class T>
inline T sumOfRow(Row<T> a)
{
    return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

template <class T>
inline T maxOfRow(Row<T> a)
{
    T m = a[0];
    for (int i = 1; i < kBlockEdge; ++i) m = a[i] > m || std::isnan(a[i]) ? a[i] : m;
    return m;
}

/// A set of cells of a block: word i holds one bit for each row, the cell at i along x.
using CellSet = Row<std::uint64_t>;

/// The cells of row r where the mask is set.
template <class Mask>
inline CellSet cellsOfRow(Mask mask, int r)
{
    return __builtin_convertvector(mask, CellSet) & (std::uint64_t{1} << r);
}

/// The rows that hold cells of the set.
inline std::uint64_t rowsOf(CellSet s) { return (s[0] | s[1]) | (s[2] | s[3]) | (s[4] | s[5]) | (s[6] | s[7]); }

inline Row<float> toFloat(Row<double> row) { return __builtin_convertvector(row, Row<float>); }

inline Row<double> toDouble(Row<float> row) { return __builtin_convertvector(row, Row<double>); }

/// parallelFor over blocks: body(b), each writes its own. Few blocks are quicker done by one thread than shared.
template <class Body>
inline void forEachBlock(int blocks, Body&& body)
{
    constexpr std::size_t kBlocksPerTask = 8;
    parallelFor(static_cast<std::size_t>(blocks), kBlocksPerTask, [&](std::size_t b) { body(static_cast<int>(b)); });
}

/// parallelFor over blocks, each with a tile to work in that a few blocks share in turn: body(b, tile).
template <class Tile, class Body>
inline void forEachBlockInTile(int blocks, Body&& body)
{
    constexpr int kBlocksPerTask = 8;
    parallelFor(static_cast<std::size_t>((blocks + kBlocksPerTask - 1) / kBlocksPerTask), [&](std::size_t task) {
        const int first = static_cast<int>(task) * kBlocksPerTask;
        Tile tile;
        for (int b = first; b < std::min(blocks, first + kBlocksPerTask); ++b) body(b, tile);
    });
}

/// Rows with j + k even, as a set of bits.
inline constexpr std::uint64_t kEvenRows = 0xAA55AA55AA55AA55u;

/// body(r) for each row of the set.
template <class Body>
inline void forEachRow(std::uint64_t rows, Body&& body)
{
    for (; rows != 0; rows &= rows - 1) body(std::countr_zero(rows));
}

}  // namespace sim
