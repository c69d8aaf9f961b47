/* system.h - what is simulated: masses, springs, gravity, pins, and the list
 * of energy terms.
 *
 * Its potential is P(x) = sum of the terms in its list (term.h).  Gravity is
 * none of them: an implicit step takes it into its target u_tilde, an explicit
 * one adds it to the acceleration, and so free fall is exact in both.  Arrays
 * change only between steps, in a term's begin and end.
 *
 * Whoever changes it says so (system_mark_changed): what solvers have computed
 * from it carries the version it was computed for.
 */
#ifndef ELASTO_SYSTEM_H
#define ELASTO_SYSTEM_H

#include <math.h>

#include "model/term.h"

enum { SYSTEM_MAX_TERMS = 12 };

/* What was taken out of a system for good, by its name in the ledger. */
typedef struct Loss {
    const char *name; /* TermKind.loss */
    double energy;    /* J */
} Loss;

struct System {
    int nodes;         /* n */
    int springs;       /* 0: no springs */
    int *e;            /* [2 springs] nodes of each spring */
    double *m;         /* [n] kg, > 0; l2 and k are in the same piece */
    double *l2;        /* [springs] m^2, rest length squared, > 0 */
    double *k;         /* [springs] J/m^2, stiffness; 0: broken, or not there */
    double gravity[2]; /* m/s^2, acceleration of every node */
    int *order;        /* [n] place of each node in the elimination order */
    unsigned char *pinned; /* [n] 1: the node never moves; both are behind e */
    double *pin_v;         /* [2n] m/s, how pins are moved; NULL: not at all */
    int segments; /* n, where nodes and springs are those of square_mesh.h */
    unsigned version; /* goes up with every change of numbers or terms */
    unsigned pattern; /* goes up where the entries of the Hessian change too */
    int terms;
    Term term[SYSTEM_MAX_TERMS]; /* the springs first, if there are any */
    Loss lost[SYSTEM_MAX_TERMS]; /* up to a name that is NULL; they stay when
                                    their term goes */
};

/* Allocates the arrays, all zero, the order that of the nodes; the list has the
 * springs' term where there are springs. Returns OK, INVALID_INPUT,
 * OUT_OF_MEMORY. */
Status system_create(int nodes, int springs, System *system);

/* Whether spring s is broken, or was cut before the start. */
static inline bool spring_is_broken(const System *system, int s)
{
    return system->k[s] == 0;
}

/* After numbers were changed; with `pattern` also pins, or which nodes a term
 * is about. */
void system_mark_changed(System *system, bool pattern);

/* Accepts a zeroed struct. */
void system_free(System *system);

/* The data of the first term of this kind; where there is none, one is put at
 * its place of the list, with so many bytes that are 0.  NULL: no memory, or
 * the list is full. */
void *system_add_term(System *system, const TermKind *kind, size_t bytes);

/* The first term of this kind, and its data, or NULL. */
Term *system_find_term(const System *system, const TermKind *kind);
void *system_term_data(const System *system, const TermKind *kind);

/* Takes it out of the list and frees its data; nothing where there is none. */
void system_remove_term(System *system, const TermKind *kind);

/* Books what a term of this kind has taken out, J. */
void system_book_loss(System *system, const TermKind *kind, double energy);

/* Checks what the struct promises: every number finite and in its range, every
 * spring between two different nodes, every bound of a term finite.  x [2n] m,
 * in: must be finite and a place that all terms allow.
 * Returns OK or INVALID_INPUT. */
Status system_check(const System *system, const double *x);

/* The smallest reach of all terms, or only of internal ones, along p at a
 * place; and whether nothing would be passed or turned over, and a tenth of
 * each distance and area would stay, if all nodes went straight from x to x +
 * p. x, p [2n] m, in. */
double system_max_step(EvalPoint at, const double *p, bool internal);
bool system_path_is_free(const System *system, const double *x,
                         const double *p);

/* P(x), J, the sum of the terms.  x [2n] m, in. */
double system_potential(const System *system, const double *x);

/* -sum m g.x, J, and whether there is gravity. */
bool system_has_gravity(const System *system);
double system_gravity_potential(const System *system, const double *x);

/* g = 0 for pinned nodes.  g [2n] in/out. */
void system_clear_pinned(const System *system, double *g);

/* a = gravity - M^-1 grad P(x), m/s^2; 0 for pinned nodes.  x [2n] m in, a [2n]
 * out. */
void system_acceleration(const System *system, const double *x, double *a);

/* Whether only gravity and internal forces act: the centre of mass falls
 * freely. */
bool system_falls_freely(const System *system);

/* sum m |v|^2 / 2, J.  v [2n] m/s, in. */
double system_kinetic(const System *system, const double *v);

/* The larger bound; NaN if one of them is. */
static inline double max_or_nan(double a, double b)
{
    return b <= a || isnan(a) ? a : b;
}

/* Bound of the curvature of all terms at rest, J/m^2: the largest of theirs. */
double system_curvature_bound(const System *system);

/* |g|_(M^-1) = sqrt(sum |g_i|^2 / m_i).  g [2n] in. */
double system_inverse_mass_norm(const System *system, const double *g);

#endif
