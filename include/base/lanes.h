/* lanes.h - several numbers in one machine instruction.
 *
 * A vector type of two doubles, an extension of C that gcc and clang share: +,
 * -, *, / and comparisons work lane by lane, with the bits that each lane would
 * have alone.  Every 64-bit processor that runs Debian has registers for it.
 */
#ifndef ELASTO_LANES_H
#define ELASTO_LANES_H

#include <string.h>

enum { LANES = 2 };

typedef double Lanes __attribute__((vector_size(LANES * sizeof(double))));
typedef long long LaneMask __attribute__((vector_size(LANES * sizeof(double))));

/* a [LANES], anywhere in memory */
static inline Lanes lanes_load(const double *a)
{
    Lanes lanes;
    memcpy(&lanes, a, sizeof lanes);
    return lanes;
}

static inline void lanes_store(double *a, Lanes lanes)
{
    memcpy(a, &lanes, sizeof lanes);
}

/* a where the mask is set, else 0 */
static inline Lanes lanes_where(LaneMask mask, Lanes a)
{
    return (Lanes)(mask & (LaneMask)a);
}

/* The sum over the lanes. */
static inline double lanes_sum(Lanes a)
{
    return a[0] + a[1];
}

#endif
