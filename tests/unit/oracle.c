#include "oracle.h"

#include <float.h>
#include <math.h>

#include "model/cells.h"
#include "model/contact.h"
#include "model/damping.h"
#include "model/friction.h"
#include "model/mass_spring_energy.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "model/pull_energy.h"

enum { MOST_UNKNOWNS = 512 };

static Jet plus(Jet a, Real factor, Jet b)
{
    return (Jet){a.f + factor * b.f, a.p + factor * b.p, a.q + factor * b.q,
                 a.pq + factor * b.pq};
}

static Jet times(Jet a, Jet b)
{
    return (Jet){a.f * b.f, a.p * b.f + a.f * b.p, a.q * b.f + a.f * b.q,
                 a.pq * b.f + a.f * b.pq + a.p * b.q + a.q * b.p};
}

/* F(a), of which F, F' and F'' are these. */
static Jet chain(Jet a, Real F, Real F1, Real F2)
{
    return (Jet){F, F1 * a.p, F1 * a.q, F1 * a.pq + F2 * a.p * a.q};
}

static void book(Spot *spot, Jet *sum, Real factor, Jet part)
{
    *sum = plus(*sum, factor, part);
    spot->size = plus(
        spot->size, fabsl(factor),
        (Jet){fabsl(part.f), fabsl(part.p), fabsl(part.q), fabsl(part.pq)});
}

/* A length that a double cannot hold to the last digit. */
static Real jittered(Spot *spot, Real x)
{
    return spot->jitter
               ? x * (1 + DBL_EPSILON * random_uniform(spot->jitter, -1, 1))
               : x;
}

/* Coordinate c of x, or of the step u that leads there. */
static Jet coordinate(Spot *spot, int c, bool of_u)
{
    const Place *at = spot->at;
    Real x;
    if (at->averaged) /* x may be NULL */
        x = (of_u ? 0 : (Real)at->x_n[c]) + spot->t * at->u[c];
    else
        x = of_u ? at->u[c] : at->x[c];
    if (spot->p)
        x += (at->averaged ? spot->t : 1) * spot->alpha * spot->p[c];
    return (Jet){jittered(spot, x), spot->p ? spot->p[c] : 0,
                 spot->q ? spot->q[c] : 0, 0};
}

static Jet between(Spot *spot, int i, int j, int axis, bool of_u)
{
    return plus(coordinate(spot, 2 * i + axis, of_u), -1,
                coordinate(spot, 2 * j + axis, of_u));
}

static Real strain_at(const System *system, int s, const double *x)
{
    int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
    Real dx = (Real)x[i] - x[j], dy = (Real)x[i + 1] - x[j + 1];
    return (dx * dx + dy * dy) / system->l2[s] - 1;
}

/* k l2 V(E): slides, plasticity.h, damping.h */
static void springs(Spot *spot, Jet *sum, const void *data)
{
    const System *system = spot->at->system;
    const Plasticity *flow = data;
    const Damping *damped = spot->at->u ? damping_of(system) : NULL;
    Real theta = damped ? damped->eta / spot->h : 0;
    for (int s = 0; s < system->springs; s++) {
        Jet E = {.f = -1}, V;
        for (int axis = 0; axis < 2; axis++) {
            Jet d = between(spot, system->e[2 * s], system->e[2 * s + 1], axis,
                            false);
            E = plus(E, 1 / (Real)system->l2[s], times(d, d));
        }
        Real e = E.f - (flow ? flow->ep[s] : 0), kappa = 0, part = 0;
        Real held = fabsl(e), over = 0; /* |e| = held + over */
        if (flow) {
            kappa = flow->kappa[s];
            part = 1 / (1 + (Real)flow->hardening);
            held = fminl(held, flow->yield + flow->hardening * kappa);
            over = fabsl(e) - held;
        }
        V = chain(E, held * (held / 2 + over) + (1 - part) * over * over / 2,
                  copysignl(held + (1 - part) * over, e),
                  over > 0 ? 1 - part : 1);
        Jet rate = E;
        rate.f -= theta > 0 ? strain_at(system, s, spot->at->x_n) : 0;
        V = plus(V, theta / 2, times(rate, rate));
        V.f += flow ? flow->hardening * kappa * kappa / 2 : 0;
        book(spot, sum, (Real)system->k[s] * system->l2[s], V);
    }
}

/* c f(s): barrier.h */
static void barrier(Spot *spot, Jet *sum, Real c, Jet s)
{
    if (s.f < 1)
        book(spot, sum, c,
             chain(s, s.f > 0 ? (s.f - 1) * logl(s.f) : INFINITY,
                   logl(s.f) + 1 - 1 / s.f, (1 + s.f) / (s.f * s.f)));
}

/* The gap of contact.h over d_hat, and the direction n from wall or ball. */
static Jet gap(Spot *spot, const Contact *contact, int i, int k, Real n[2])
{
    const Obstacle *it = &contact->obstacle[k];
    Jet d[2], s = {0};
    for (int axis = 0; axis < 2; axis++) {
        d[axis] = it->node >= 0 ? between(spot, i, it->node, axis, false)
                                : coordinate(spot, 2 * i + axis, false);
        d[axis].f -= it->node >= 0 ? 0 : jittered(spot, it->o[axis]);
        n[axis] = it->n[axis];
    }
    if (it->kind == OBSTACLE_BALL) {
        Jet r2 = plus(times(d[0], d[0]), 1, times(d[1], d[1]));
        Real r = sqrtl(r2.f);
        s = chain(r2, r - it->radius, 1 / (2 * r), -1 / (4 * r2.f * r));
        n[0] = d[0].f / r;
        n[1] = d[1].f / r;
    } else {
        s = plus((Jet){0}, n[0], d[0]);
        s = plus(s, n[1], d[1]);
    }
    if (contact->ball >= 0 && contact->obstacle[contact->ball].node == i)
        s.f -= contact->obstacle[contact->ball].radius;
    return plus((Jet){0}, 1 / (Real)contact->barrier.d_hat, s);
}

/* mu lambda f0(y), lambda and t of x_n: friction.h */
static void friction(Spot *spot, Jet *sum, const Contact *contact, int i, int k)
{
    const Obstacle *it = &contact->obstacle[k];
    const Term *term = system_find_term(spot->at->system, &friction_energy);
    if (!term || !spot->at->u || !(it->friction > 0))
        return;
    Place start = *spot->at;
    Spot before = {.at = &start, .h = spot->h, .jitter = spot->jitter};
    Real n[2], e = ((const Friction *)term->data)->slip_speed * spot->h;
    start.x = start.x_n;
    start.averaged = false;
    Real s = gap(&before, contact, i, k, n).f;
    if (!(s < 1))
        return;
    Jet y = {.f = -spot->h * (n[0] * jittered(spot, it->v[1]) -
                              n[1] * jittered(spot, it->v[0]))};
    for (int axis = 0; axis < 2; axis++)
        y = plus(y, axis ? n[0] : -n[1],
                 it->node >= 0 ? between(spot, i, it->node, axis, true)
                               : coordinate(spot, 2 * i + axis, true));
    Real a = fabsl(y.f) / e, sign = copysignl(1, y.f);
    Jet f0 = a < 1 ? chain(y, y.f * y.f / e * (1 - a / 3), sign * a * (2 - a),
                           2 / e * (1 - a))
                   : chain(y, fabsl(y.f) - e / 3, sign, 0);
    book(spot, sum,
         it->friction * contact->barrier.c / contact->barrier.d_hat *
             -(logl(s) + 1 - 1 / s),
         f0);
}

/* c f(d/d_hat): contact.h */
static void touch(Spot *spot, Jet *sum, const Contact *contact, int i, int k)
{
    Real n[2];
    barrier(spot, sum, contact->barrier.c, gap(spot, contact, i, k, n));
}

static void contacts(Spot *spot, Jet *sum, const void *data)
{
    const System *system = spot->at->system;
    const Contact *contact = contact_of(system);
    for (int k = 0; contact && k < contact->obstacles; k++)
        for (int i = 0; i < system->nodes; i++)
            if (contact_has_pair(contact, system, i, k))
                (data == contact ? touch : friction)(spot, sum, contact, i, k);
}

/* Whether triangle t of the cells has all its springs, and its area over that
 * at rest. */
static bool triangle(Spot *spot, const Cells *cells, int t, Jet *J)
{
    const double *k = spot->at->system->k;
    const int *node = cells->node + 3 * t, *side = cells->spring + 3 * t;
    Jet e[2][2];
    if (k[side[0]] == 0 || k[side[1]] == 0 || k[side[2]] == 0)
        return false;
    for (int axis = 0; axis < 2; axis++)
        for (int edge = 0; edge < 2; edge++)
            e[edge][axis] = between(spot, node[1 + edge], node[0], axis, false);
    *J = plus(times(e[0][0], e[1][1]), -1, times(e[0][1], e[1][0]));
    *J = plus((Jet){0}, 1 / (2 * (Real)cells->area), *J);
    return true;
}

/* A0 k_c f(J/J_hat): cells.h */
static void cells(Spot *spot, Jet *sum, const void *data)
{
    const Cells *cells = data;
    Jet J;
    for (int t = 0; t < cells->triangles; t++)
        if (triangle(spot, cells, t, &J))
            barrier(spot, sum, cells->c, plus((Jet){0}, 1 / 0.4L, J));
}

/* A0 (mu/2 (|F|^2 - 2) - mu ln J + lambda/2 (ln J)^2): neo_hookean.h */
static void solids(Spot *spot, Jet *sum, const void *data)
{
    const NeoHookean *solid = data;
    for (int t = 0; t < solid->triangles; t++) {
        Jet F[4] = {{0}}, size = {.f = -2}, J, L;
        for (int c = 0; c < 4; c++)
            for (int k = 0; k < 3; k++)
                F[c] = plus(
                    F[c], solid->weight[t][c / 2][k],
                    coordinate(spot, 2 * solid->node[t][k] + c % 2, false));
        for (int c = 0; c < 4; c++)
            size = plus(size, 1, times(F[c], F[c]));
        J = plus(times(F[0], F[3]), -1, times(F[1], F[2]));
        if (!(J.f > 0)) {
            book(spot, sum, 1, (Jet){.f = INFINITY});
            continue;
        }
        L = chain(J, logl(J.f), 1 / J.f, -1 / (J.f * J.f));
        book(spot, sum, solid->area * (Real)solid->mu / 2, size);
        book(spot, sum, -solid->area * (Real)solid->mu, L);
        book(spot, sum, solid->area * (Real)solid->lambda / 2, times(L, L));
    }
}

/* sum c/2 |x - o|^2: pull_energy.h */
static void pulls(Spot *spot, Jet *sum, const void *data)
{
    const Pull *pull = data;
    const System *system = spot->at->system;
    for (int c = 0; c < 2 * system->nodes; c++) {
        Jet d = coordinate(spot, c, false);
        Real k = pull->node < 0 ? (Real)pull->k * system->m[c / 2] : pull->k;
        d.f -= pull->target[c % 2];
        if (pull->node < 0 || pull->node == c / 2)
            book(spot, sum, k / 2, times(d, d));
    }
}

/* A new term is a row here; data: the term's. */
static const struct {
    const TermKind *kind;
    void (*formula)(Spot *spot, Jet *sum, const void *data);
} formulas[] = {{&mass_spring_energy, springs}, {&plastic_energy, springs},
                {&contact_energy, contacts},    {&friction_energy, contacts},
                {&cell_energy, cells},          {&central_field, pulls},
                {&hand_energy, pulls},          {&neo_hookean_energy, solids}};

Jet oracle_energy(Spot *spot, const TermKind *only)
{
    const System *system = spot->at->system;
    Jet sum = {0};
    spot->size = (Jet){0};
    for (int i = 0; i < system->terms; i++) {
        const TermKind *kind = system->term[i].kind;
        for (size_t f = 0; f < sizeof formulas / sizeof *formulas; f++)
            if (formulas[f].kind == kind &&
                (!only || kind == only || kind->averaged == only))
                formulas[f].formula(spot, &sum, system->term[i].data);
    }
    spot->size = plus((Jet){0}, spot->at->w, spot->size);
    return plus((Jet){0}, spot->at->w, sum);
}

Jet oracle_step(Spot *spot, const double *u_tilde)
{
    const System *system = spot->at->system;
    Jet sum = oracle_energy(spot, NULL);
    for (int c = 0; c < 2 * system->nodes; c++) {
        Jet away = coordinate(spot, c, true);
        away.f -= u_tilde[c];
        book(spot, &sum, system->m[c / 2] / (Real)2, times(away, away));
    }
    return sum;
}

/* ---- of a minimisation ------------------------------------------------- */

static Jet step_jet(const IncrementalPotential *E, const double *u,
                    const double *x, const double *p, const double *q)
{
    Place at = place_at(E->system, E->x_n, u, x);
    at.w = E->weight;
    Spot spot = {.at = &at, .h = 1, .t = 1, .p = p, .q = q};
    return u ? oracle_step(&spot, E->u_tilde) : oracle_energy(&spot, NULL);
}

Real exact_energy(const IncrementalPotential *E, const double *u,
                  const double *x)
{
    return step_jet(E, u, x, NULL, NULL).f;
}

void exact_derivatives(const IncrementalPotential *E, const double *u,
                       const double *x, Real *g, Real *H)
{
    int size = 2 * E->system->nodes;
    double p[MOST_UNKNOWNS] = {0}, q[MOST_UNKNOWNS] = {0};
    CHECK(size <= MOST_UNKNOWNS);
    for (int i = 0; i < size; i++) {
        p[i] = 1;
        g[i] = step_jet(E, u, x, p, NULL).p;
        for (int j = 0; H && j < size; j++) {
            q[j] = 1;
            H[size * i + j] = step_jet(E, u, x, p, q).pq;
            q[j] = 0;
        }
        p[i] = 0;
    }
}

/* Adds lambda q q^T of the direction q across the spring's four unknowns:
 * [q, -q] [q, -q]^T. */
static void add_mode(const System *system, int s, Real lambda, const Real q[2],
                     Real *H)
{
    int size = 2 * system->nodes;
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            int row = 2 * system->e[2 * s + r / 2] + r % 2;
            int column = 2 * system->e[2 * s + c / 2] + c % 2;
            Real sign = r / 2 == c / 2 ? 1 : -1;
            H[size * row + column] += sign * lambda * q[r % 2] * q[c % 2];
        }
}

void exact_hessian(const IncrementalPotential *E, const double *x, bool clamp,
                   Real *H)
{
    const System *system = E->system;
    int size = 2 * system->nodes;
    for (int i = 0; i < size * size; i++)
        H[i] = i % (size + 1)
                   ? 0
                   : system->m[i / size / 2] *
                         (1 + (Real)E->weight * central_omega2(system));
    for (int s = 0; s < system->springs; s++) {
        int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
        Real dx = (Real)x[i] - x[j], dy = (Real)x[i + 1] - x[j + 1];
        Real length = hypotl(dx, dy), l2 = system->l2[s];
        Real factor = 2 * (Real)E->weight * system->k[s] / l2;
        Real along = factor * (3 * length * length - l2);
        Real across = factor * (length * length - l2);
        Real q[2] = {1, 0}, r[2] = {0, 1};
        if (length > 0) {
            q[0] = r[1] = dx / length;
            q[1] = dy / length;
            r[0] = -q[1];
        }
        add_mode(system, s, clamp ? fmaxl(along, 0) : along, q, H);
        add_mode(system, s, clamp ? fmaxl(across, 0) : across, r, H);
    }
}

void exact_eigen(int n, Real *a, Real *v)
{
    for (int i = 0; i < n * n; i++)
        v[i] = i % (n + 1) == 0;
    for (int k = 0; k < 30 * n * n; k++) {
        int r = k / n % n, c = k % n;
        if (r >= c || a[n * r + c] == 0)
            continue;
        Real theta = (a[n * c + c] - a[n * r + r]) / (2 * a[n * r + c]);
        Real t = copysignl(1, theta) / (fabsl(theta) + hypotl(1, theta));
        Real cosine = 1 / hypotl(1, t), sine = t * cosine;
        for (int pass = 0; pass < 3; pass++)
            for (int i = 0; i < n; i++) {
                Real *m = pass == 2 ? v : a;
                int j = pass == 1 ? n * r + i : n * i + r;
                int l = pass == 1 ? n * c + i : n * i + c;
                Real one = m[j], two = m[l];
                m[j] = cosine * one - sine * two;
                m[l] = sine * one + cosine * two;
            }
    }
}

void make_psd(double a[16])
{
    Real l[16], q[16];
    for (int i = 0; i < 16; i++)
        l[i] = a[i];
    exact_eigen(4, l, q);
    for (int i = 0; i < 16; i++) {
        Real sum = 0;
        for (int k = 0; k < 4; k++)
            sum += fmaxl(l[5 * k], 0) * q[i / 4 * 4 + k] * q[i % 4 * 4 + k];
        a[i] = (double)sum;
    }
}

/* ---- what must stay above 0 ---------------------------------------------- */

double exact_gap(const System *system, const double *x, int node, int obstacle)
{
    const Contact *contact = contact_of(system);
    Place at = place_at(system, x, NULL, x);
    Spot spot = {.at = &at};
    Real n[2];
    return (double)(contact->barrier.d_hat *
                    gap(&spot, contact, node, obstacle, n).f);
}

double smallest_gap(const System *system, const double *x)
{
    const Contact *contact = contact_of(system);
    double smallest = INFINITY;
    for (int k = 0; contact && k < contact->obstacles; k++)
        for (int i = 0; i < system->nodes; i++)
            if (contact_has_pair(contact, system, i, k))
                smallest = fmin(smallest, exact_gap(system, x, i, k));
    return smallest;
}

double smallest_cell(const System *system, const double *x)
{
    const Term *term = system_find_term(system, &cell_energy);
    const Cells *cells = term ? term->data : NULL;
    Place at = place_at(system, x, NULL, x);
    Spot spot = {.at = &at};
    double smallest = INFINITY;
    Jet J;
    for (int t = 0; cells && t < cells->triangles; t++)
        if (triangle(&spot, cells, t, &J))
            smallest = fmin(smallest, (double)J.f);
    return smallest;
}
