/* grid_loops.h - how loops go through a grid: some nodes at once, each with its
 * springs.  Plain loops over LANES nodes, which the compiler vectorises.
 */
#ifndef ELASTO_GRID_LOOPS_H
#define ELASTO_GRID_LOOPS_H

#include <stdint.h> /* any header of the library: says whether it is glibc */

#include "solve/grid.h"

/* A loop that is compiled for several widths of registers, of which the
 * processor's is taken as the program starts.  Sums have one shape and products
 * are not contracted, so that they agree in every bit. */
#ifndef FAST
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__OPTIMIZE__) &&      \
    !defined(__clang__)
#define FAST __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define FAST
#endif
#endif

/* A function that is a part of a FAST loop. */
#define INLINE static inline __attribute__((always_inline))

/* Nodes of one row that stand side by side, and where their neighbours and
 * their numbers are. */
typedef struct NodeRun {
    int first, end;    /* places of the first node, past the last one */
    int next;          /* from a node to the next row */
    int before, after; /* ... to the columns before and after its own */
    int own, below;    /* ... to the numbers of springs that start in its row,
                          and in the row before */
    int node;          /* ... to its mass */
} NodeRun;

INLINE NodeRun nodes_in_row(const Rows *rows, int i, int odd)
{
    int first = (i + 1) * rows->pitch + odd * rows->half;
    int before = odd ? -rows->half : rows->half - 1;
    return (NodeRun){.first = first,
                     .end = first + rows->count[odd],
                     .next = rows->pitch,
                     .before = before,
                     .after = before + 1};
}

/* LANES (or WIDE_LANES) nodes from `first` on, of which none changes what
 * another one reads; e counts them.  A loop that is unrolled first is not
 * vectorised. */
#ifdef __clang__
#define AT_ONCE _Pragma("clang loop vectorize(assume_safety) unroll(disable)")
#else
#define AT_ONCE _Pragma("GCC unroll 1") _Pragma("GCC ivdep")
#endif
#define EACH_OF(lanes) AT_ONCE for (int e = 0; e < (lanes); e++)

/* The number of a run's next nodes, up to `lanes`.  Where registers are narrow,
 * lanes behind the end of the run, which stay 0, are left out. */
#ifdef __wasm_simd128__
#define AT_MOST(lanes, left)                                                   \
    ((left) < (lanes) ? ((left) + (lanes) / 4 - 1) & -((lanes) / 4) : (lanes))
#else
#define AT_MOST(lanes, left) (lanes)
#endif
#define NEXT(at, lanes) AT_MOST(lanes, (at).end - (at).first)

/* A loop whose numbers are Few (or Pairs): in a page so many of single (or
 * double) precision at once, for there what comes from several springs has to
 * be added up in order (IN_ORDER) to stay in registers; elsewhere one, as in
 * any loop. */
#ifdef __wasm_simd128__
typedef float Few __attribute__((vector_size(16), aligned(4)));
typedef double Pair __attribute__((vector_size(16), aligned(8)));
enum { PAIRED = 2 };
#define FEW(a, q)      (*(Few *)((a) + (q)))
#define PAIR(a, q)     (*(Pair *)((a) + (q)))
#define IN_ORDER(a, b) __asm__ volatile("" : "+r"(a), "+r"(b))
#define EACH_BY(n, lanes)                                                      \
    _Pragma("clang loop unroll(disable)") for (int e = 0; e < (lanes); e += n)
#define EACH_FEW(lanes)  EACH_BY (4, lanes)
#define EACH_PAIR(lanes) EACH_BY (2, lanes)
#define WHERE(condition, a)                                                    \
    ((__typeof__(a))((condition) & (__typeof__(condition))(a)))
#else
typedef float Few;
typedef double Pair;
enum { PAIRED = 0 };
#define FEW(a, q)           ((a)[q])
#define PAIR(a, q)          ((a)[q])
#define IN_ORDER(a, b)      (void)0
#define EACH_FEW(lanes)     EACH_OF (lanes)
#define EACH_PAIR(lanes)    EACH_OF (lanes)
#define WHERE(condition, a) ((condition) ? (a) : 0)
#endif

/* The springs of a node: their kind, where their other node is, and where their
 * numbers are.  Two are in the node's row, six lead to the next rows; four of
 * all start at the node. */
#define ROW_SPRINGS(F, at)                                                     \
    F(UP, (at).after, (at).own)                                                \
    F(UP, (at).before, (at).own + (at).before)
#define CROSS_SPRINGS(F, at)                                                   \
    F(RIGHT, (at).next, (at).own)                                              \
    F(RIGHT, -(at).next, (at).below - (at).next)                               \
    F(DIAGONAL, (at).next + (at).after, (at).own)                              \
    F(DIAGONAL, (at).before - (at).next, (at).below + (at).before - (at).next) \
    F(ANTIDIAGONAL, (at).next + (at).before, (at).own)                         \
    F(ANTIDIAGONAL, (at).after - (at).next, (at).below + (at).after - (at).next)
#define ALL_SPRINGS(F, at) ROW_SPRINGS(F, at) CROSS_SPRINGS(F, at)
#define OWN_SPRINGS(F, at)                                                     \
    F(RIGHT, (at).next, (at).own)                                              \
    F(UP, (at).after, (at).own)                                                \
    F(DIAGONAL, (at).next + (at).after, (at).own)                              \
    F(ANTIDIAGONAL, (at).next + (at).before, (at).own)

/* nodes_in_row for row i of the step's grid, whose rows may share numbers. */
INLINE NodeRun grid_nodes(const Grid *grid, int i, int odd)
{
    NodeRun at = nodes_in_row(&grid->rows, i, odd);
    at.own = grid->spring_shift[i + 1];
    at.below = grid->spring_shift[i];
    at.node = grid->node_shift[i];
    return at;
}

/* EACH_RUN_OF loops over the nodes of a band, LANES of a row at once in `at`;
 * EACH_NODE_OF also over their Pairs, counted by `e`. */
#define EACH_RUN_OF(grid, band)                                                \
    for (int i = (band)*BAND; i < (band)*BAND + BAND && i < (grid).rows.nodes; \
         i++)                                                                  \
        for (int odd = 0; odd < 2; odd++)                                      \
            for (NodeRun at = grid_nodes(&(grid), i, odd); at.first < at.end;  \
                 at.first += LANES)
#define EACH_NODE_OF(grid, band)                                               \
    EACH_RUN_OF (grid, band)                                                   \
        EACH_PAIR (NEXT(at, LANES))

/* The parts of a sum, in one order always. */
INLINE double sum_lanes(const double s[LANES])
{
    return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

#endif
