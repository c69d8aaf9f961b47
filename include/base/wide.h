/* wide.h - several numbers in one machine instruction, by extensions of C that
 * gcc and clang share: +, -, *, / and comparisons work lane by lane, with the
 * bits that each lane would have alone.
 *
 * A source with loops over lanes ends in .inc and is included once for each
 * width, after
 *   #define REAL   double or float
 *   #define WIDTH  how many of them
 *   #define TARGET an attribute that lets functions use such registers
 *   #define OF     a word of its own, the same for all widths
 * It begins with #include "base/wide.inc", and its own names are EACH(name).
 */
#ifndef ELASTO_WIDE_H
#define ELASTO_WIDE_H

#include <string.h>

#define WIDE_PASTE(name, of, real, width) name##_##of##_##real##width
#define WIDE_NAME(name, of, real, width)  WIDE_PASTE(name, of, real, width)
#define EACH(name)                        WIDE_NAME(name, OF, REAL, WIDTH)

#define INLINE_LANES TARGET static inline __attribute__((always_inline))

#define Wide          EACH(Wide)
#define WideMask      EACH(WideMask)
#define WideInteger   EACH(WideInteger)
#define wide_load     EACH(wide_load)
#define wide_store    EACH(wide_store)
#define wide_all      EACH(wide_all)
#define wide_where    EACH(wide_where)
#define wide_positive EACH(wide_positive)
#define wide_even     EACH(wide_even)
#define wide_between  EACH(wide_between)
#define wide_ahead    EACH(wide_ahead)

/* Lanes of two registers a and b in a new order; those of b count on. */
#ifdef __clang__
#define wide_shuffle(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define wide_shuffle(a, b, ...) __builtin_shuffle(a, b, (WideMask){__VA_ARGS__})
#endif

#define WIDE_LIST(name, width)   WIDE_PASTE2(name, width)
#define WIDE_PASTE2(name, width) name##_##width

/* 0, 2, 4 ...; 0, 0, 1, 1 ...; 0, 1, 1, 2, 2 ... for each width */
#define WIDE_EVEN_2  0, 2
#define WIDE_EVEN_4  WIDE_EVEN_2, 4, 6
#define WIDE_EVEN_8  WIDE_EVEN_4, 8, 10, 12, 14
#define WIDE_EVEN_16 WIDE_EVEN_8, 16, 18, 20, 22, 24, 26, 28, 30
#define WIDE_LOW_2   0, 0
#define WIDE_LOW_4   WIDE_LOW_2, 1, 1
#define WIDE_LOW_8   WIDE_LOW_4, 2, 2, 3, 3
#define WIDE_LOW_16  WIDE_LOW_8, 4, 4, 5, 5, 6, 6, 7, 7
#define WIDE_HIGH_2  0, 1
#define WIDE_HIGH_4  WIDE_HIGH_2, 1, 2
#define WIDE_HIGH_8  WIDE_HIGH_4, 2, 3, 3, 4
#define WIDE_HIGH_16 WIDE_HIGH_8, 4, 5, 5, 6, 6, 7, 7, 8

/* The most doubles this processor has in one register: 2, 4 or 8. */
static inline int wide_doubles(void)
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f"))
        return 8;
    if (__builtin_cpu_supports("avx2"))
        return 4;
#endif
    return 2;
}

/* What a function needs to use 4 and 8 doubles at once. */
#if defined(__x86_64__)
#define TARGET_4 __attribute__((target("avx2")))
#define TARGET_8 __attribute__((target("avx512f,avx512dq")))
#else
#define TARGET_4
#define TARGET_8
#endif

#endif
