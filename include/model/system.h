/* system.h - the simulated system: masses, springs, gravity, pins, and the list
 * of energy terms.
 *
 * The potential P(x) is the sum of the terms in the list (term.h).  Gravity is
 * not a term: an implicit step adds it to its target u_tilde, an explicit step
 * to the acceleration, so the velocity in free fall is exact.  Arrays change
 * between steps only: by control_apply, state_restore, exhibit_flip_switch, a
 * term's begin_step and end_step, and envelope_run_cell.
 *
 * Code that changes a system calls system_mark_changed, which raises its
 * version.  Solvers store the version for which their results are valid. */
#pragma once

#include <math.h>

#include "model/term.h"

enum { SYSTEM_MAX_TERMS = 12 };

/* Energy that a system lost for good, for one column of the ledger. */
typedef struct EnergyLoss {
    const char *name; /* name of the column */
    double energy;    /* J */
} EnergyLoss;

struct System {
    int nodes;   /* n */
    int springs; /* number of springs */
    int *e;      /* [2 springs] nodes of each spring */
    double *m;   /* [n] kg, > 0 */
    double *l2;  /* [springs] m^2, rest length squared, > 0 */
    double *k;   /* [springs] J/m^2, stiffness; 0: broken, cut or unused */
    double gravity[2];        /* m/s^2, acceleration of every node */
    int *elimination_index;   /* [n] place of each node in the elimination */
    unsigned char *is_pinned; /* [n] 1: pinned, 0: free */
    double *pin_v;            /* [2n] m/s, velocity of pinned nodes; NULL: 0 */
    int segments;     /* segments a side if there is one square, else 0 */
    unsigned version; /* rises with every change of numbers or terms */
    unsigned pattern_version; /* rises when the Hessian's pattern changes */
    int term_count;           /* number of terms */
    EnergyTerm term[SYSTEM_MAX_TERMS]; /* terms in the order of TermKind.rank */
    /* Lost energy by column, up to a NULL name; stays when its term goes. */
    EnergyLoss losses[SYSTEM_MAX_TERMS];
};

/* Allocates the arrays, filled with 0; elimination_index[i] is i.  The list has
 * the springs' term if springs > 0.  Returns OK or OUT_OF_MEMORY. */
Status system_create(int nodes, int springs, System *system);

/* Whether spring s broke, was cut, or is a diagonal that triangles lack. */
static inline bool spring_is_broken(const System *system, int s)
{
    return system->k[s] == 0;
}

/* Raises the version, after numbers have changed; with `pattern` also the
 * version of the pattern, after pins or the nodes of a term have changed. */
void system_mark_changed(System *system, bool pattern);

/* Frees all arrays and terms.  Accepts a zeroed struct. */
void system_free(System *system);

/* ---- the list of terms (term.c) ------------------------------------------ */

/* Returns the data of the first term of this kind.  If there is none, adds one
 * at its place in the list, with `bytes` bytes of data, all 0.  NULL: no
 * memory, or the list is full. */
void *system_add_term(System *system, const TermKind *kind, size_t bytes);

/* Returns the first term of this kind, or NULL. */
EnergyTerm *system_find_term(const System *system, const TermKind *kind);

/* Returns the data of the first term of this kind, or NULL. */
void *system_term_data(const System *system, const TermKind *kind);

/* Removes the first term of this kind, if there is one, and frees its data. */
void system_remove_term(System *system, const TermKind *kind);

/* Adds `energy` (J) to the loss of this kind's column of the ledger. */
void system_add_loss(System *system, const TermKind *kind, double energy);

/* ---- sums over all terms and nodes (system.c) ---------------------------- */

/* Whether the point is feasible for all terms (elements_are_feasible). */
bool system_is_feasible(EvalPoint at);

/* Returns the step alpha along p [2n] m, in, up to which all terms' gaps and
 * areas stay positive; infinite if above 1.  `internal`: no external terms. */
double system_max_alpha(EvalPoint at, const double *p, bool internal);

/* Whether all nodes can move straight from x to x + p so that no body passes
 * through another one, no cell turns over, and a tenth of each distance and
 * area remains.  x, p [2n] m, in. */
bool system_path_is_free(const System *system, const double *x,
                         const double *p);

/* Returns P(x) in joules, the sum of the terms.  x [2n] m, in. */
double system_potential(const System *system, const double *x);

bool system_has_gravity(const System *system);

/* Returns -sum m g.x in joules; 0 if only rounding is left.  x [2n] m, in. */
double system_gravity_potential(const System *system, const double *x);

/* Sets g to 0 at pinned nodes.  g [2n] in/out. */
void system_zero_pinned_entries(const System *system, double *g);

/* Writes a = gravity - M^-1 grad P(x), and 0 at pinned nodes.
 *   x  [2n] m, in
 *   a  [2n] m/s^2, out */
void system_acceleration(const System *system, const double *x, double *a);

/* Whether the centre of mass falls freely: no pins, no external terms. */
bool system_falls_freely(const System *system);

/* Whether P stays the same when all nodes turn about the pivot: no term is
 * external or depends on x_n, and at most one node is pinned.
 *   pivot  out, the pinned node; -1: the centre of mass */
bool system_turns_freely(const System *system, int *pivot);

/* Returns the kinetic energy sum m |v|^2/2 in joules.  v [2n] m/s, in. */
double system_kinetic_energy(const System *system, const double *v);

/* Returns the larger of two numbers; NaN if one of them is NaN. */
static inline double max_or_nan(double a, double b)
{
    return b <= a || isnan(a) ? a : b;
}

/* Returns the largest max_stiffness of all terms (J/m^2). */
double system_max_stiffness(const System *system);

/* Returns |g|_(M^-1) = sqrt(sum |g_i|^2/m_i).  g [2n] in. */
double system_inverse_mass_norm(const System *system, const double *g);
