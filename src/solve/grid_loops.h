/* grid_loops.h - loops over the nodes of a grid, several nodes at once, and
 * over the springs of each node. */
#pragma once

#include <stdint.h> /* defines __GLIBC__ if the library is glibc */
#ifdef __wasm_simd128__
#include <wasm_simd128.h>
#endif

#include "solve/grid.h"

/* Marks a function that is compiled for several widths of registers; at its
 * start the program selects the version for the processor.  All versions give
 * the same bits: additions have one order, and no multiply-add is fused. */
#ifndef FAST
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__OPTIMIZE__) &&      \
    !defined(__clang__)
#define FAST __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define FAST
#endif
#endif

/* Marks a function that is compiled into the FAST function that calls it. */
#define INLINE static inline __attribute__((always_inline))

/* Nodes of one row, contiguous in memory, with index distances to neighbours,
 * springs and masses.  ptrdiff_t needs no conversion in addresses. */
typedef struct NodeRange {
    ptrdiff_t first, end;  /* index of the first node, and past the last one */
    ptrdiff_t to_next_row; /* distance from a node to the next row */
    ptrdiff_t to_column_before,
        to_column_after; /* distances to the columns before and after */
    ptrdiff_t spring_shift,
        spring_shift_before; /* spring_shift of this row, row before */
    ptrdiff_t mass_shift;    /* mass index of a node minus node index */
} NodeRange;

INLINE NodeRange get_node_range(const RowLayout *rows, int i, int odd)
{
    int first = (i + 1) * rows->pitch + odd * rows->odd_offset;
    int before = odd ? -rows->odd_offset : rows->odd_offset - 1;
    return (NodeRange){.first = first,
                       .end = first + rows->column_count[odd],
                       .to_next_row = rows->pitch,
                       .to_column_before = before,
                       .to_column_after = before + 1};
}

/* EACH_OF is a loop with counter e over independent nodes: no node changes what
 * another node reads.  The compiler vectorises the loop; AT_ONCE keeps the
 * compiler from unrolling the loop first. */
#ifdef __clang__
#define AT_ONCE _Pragma("clang loop vectorize(assume_safety) unroll(disable)")
#else
#define AT_ONCE _Pragma("GCC unroll 1") _Pragma("GCC ivdep")
#endif
#define EACH_OF(lanes) AT_ONCE for (int e = 0; e < (lanes); e++)

/* NEXT is the number of nodes that a loop handles next: always `lanes`, because
 * numbers past the end of the run stay 0.  In a browser, where registers are
 * narrow, NEXT is at most the nodes left, rounded up to whole vectors. */
#ifdef __wasm_simd128__
#define AT_MOST(lanes, left)                                                   \
    ((left) < (lanes) ? ((left) + (lanes) / 4 - 1) & -((lanes) / 4) : (lanes))
#else
#define AT_MOST(lanes, left) (lanes)
#endif
#define NEXT(at, lanes) AT_MOST(lanes, (at).end - (at).first)

/* Floats and Doubles are the numbers of one iteration of EACH_FLOATS and
 * EACH_DOUBLES.  In a browser they are vectors of four floats or two doubles.
 * IN_ORDER makes the browser's code add one spring after the other, so that the
 * sums stay in registers.  Elsewhere Floats and Doubles are single numbers, and
 * the compiler vectorises the loop. */
#ifdef __wasm_simd128__
typedef float Floats __attribute__((vector_size(16), aligned(4)));
typedef double Doubles __attribute__((vector_size(16), aligned(8)));
enum { HIGH_HALF_OFFSET = 2 };
#define FLOATS(a, q)   (*(Floats *)((a) + (q)))
#define DOUBLES(a, q)  (*(Doubles *)((a) + (q)))
#define IN_ORDER(a, b) __asm__ volatile("" : "+r"(a), "+r"(b))
#define EACH_BY(n, lanes)                                                      \
    _Pragma("clang loop unroll(disable)") for (int e = 0; e < (lanes); e += n)
#define EACH_FLOATS(lanes)  EACH_BY (4, lanes)
#define EACH_DOUBLES(lanes) EACH_BY (2, lanes)
#define WHERE(condition, a)                                                    \
    ((__typeof__(a))((condition) & (__typeof__(condition))(a)))
#else
typedef float Floats;
typedef double Doubles;
enum { HIGH_HALF_OFFSET = 0 };
#define FLOATS(a, q)        ((a)[q])
#define DOUBLES(a, q)       ((a)[q])
#define IN_ORDER(a, b)      (void)0
#define EACH_FLOATS(lanes)  EACH_OF (lanes)
#define EACH_DOUBLES(lanes) EACH_OF (lanes)
#define WHERE(condition, a) ((condition) ? (a) : 0)
#endif

/* Converts `low` to single precision; in a browser also `high`. */
INLINE Floats narrow_to_single(Doubles low, Doubles high)
{
#ifdef __wasm_simd128__ /* clang does not generate `demote` by itself */
    v128_t few = wasm_f32x4_demote_f64x2_zero((v128_t)low);
    v128_t more = wasm_f32x4_demote_f64x2_zero((v128_t)high);
    return (Floats)wasm_i32x4_shuffle(few, more, 0, 1, 4, 5);
#else
    (void)high;
    return (float)low;
#endif
}

/* Computes to = factor (from - middle) in single precision.
 *   count  of numbers, a multiple of LANES */
INLINE void narrow_array_to_single(const double *from, double factor,
                                   double middle, int count, float *to)
{
    for (; count > 0; count -= LANES, from += LANES, to += LANES)
        EACH_FLOATS (LANES)
            FLOATS(to, e) = narrow_to_single(
                factor * (DOUBLES(from, e) - middle),
                factor * (DOUBLES(from, e + HIGH_HALF_OFFSET) - middle));
}

/* Calls F(kind, to, numbers) for springs of a node q: the other node has the
 * index q + to, the spring q + numbers.  ROW_SPRINGS are the 2 springs in the
 * row, CROSS_SPRINGS the other 6, OWN_SPRINGS the 4 that start at the node. */
#define ROW_SPRINGS(F, at)                                                     \
    F(UP, (at).to_column_after, (at).spring_shift)                             \
    F(UP, (at).to_column_before, (at).spring_shift + (at).to_column_before)
#define CROSS_SPRINGS(F, at)                                                   \
    F(RIGHT, (at).to_next_row, (at).spring_shift)                              \
    F(RIGHT, -(at).to_next_row, (at).spring_shift_before - (at).to_next_row)   \
    F(DIAGONAL, (at).to_next_row + (at).to_column_after, (at).spring_shift)    \
    F(DIAGONAL, (at).to_column_before - (at).to_next_row,                      \
      (at).spring_shift_before + (at).to_column_before - (at).to_next_row)     \
    F(ANTIDIAGONAL, (at).to_next_row + (at).to_column_before,                  \
      (at).spring_shift)                                                       \
    F(ANTIDIAGONAL, (at).to_column_after - (at).to_next_row,                   \
      (at).spring_shift_before + (at).to_column_after - (at).to_next_row)
#define ALL_SPRINGS(F, at) ROW_SPRINGS(F, at) CROSS_SPRINGS(F, at)
#define OWN_SPRINGS(F, at)                                                     \
    F(RIGHT, (at).to_next_row, (at).spring_shift)                              \
    F(UP, (at).to_column_after, (at).spring_shift)                             \
    F(DIAGONAL, (at).to_next_row + (at).to_column_after, (at).spring_shift)    \
    F(ANTIDIAGONAL, (at).to_next_row + (at).to_column_before, (at).spring_shift)

/* Returns the nodes in even or odd columns of row i, with the row's shifts. */
INLINE NodeRange grid_get_node_range(const Grid *grid, int i, int odd)
{
    NodeRange at = get_node_range(&grid->rows, i, odd);
    at.spring_shift = grid->spring_shift[i + 1];
    at.spring_shift_before = grid->spring_shift[i];
    at.mass_shift = grid->mass_shift[i];
    return at;
}

/* EACH_RUN_OF loops over the nodes of a band, LANES of a row at a time, from
 * at.first on; EACH_NODE_OF goes through these by vectors of Doubles. */
#define EACH_RUN_OF(grid, band)                                                \
    for (int i = (band)*BAND_ROWS;                                             \
         i < (band)*BAND_ROWS + BAND_ROWS && i < (grid).rows.nodes_per_side;   \
         i++)                                                                  \
        for (int odd = 0; odd < 2; odd++)                                      \
            for (NodeRange at = grid_get_node_range(&(grid), i, odd);          \
                 at.first < at.end; at.first += LANES)
#define EACH_NODE_OF(grid, band)                                               \
    EACH_RUN_OF (grid, band)                                                   \
        EACH_DOUBLES (NEXT(at, LANES))

/* Adds the partial sums of the lanes, always in the same order. */
INLINE double sum_lanes(const double s[LANES])
{
    return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}
