#include "oracle.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "model/cells.h"
#include "model/damping.h"
#include "model/friction.h"
#include "model/mass_spring_energy.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "model/pull_energy.h"
#include "model/self_contact.h"

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
    Real t = spot->t > 0 ? spot->t : 1, x;
    if (of_u)
        x = at->u[c];
    else if (spot->t > 0 || !at->x)
        x = at->x_n[c] + t * at->u[c];
    else
        x = at->x[c];
    if (spot->p)
        x += t * spot->alpha * spot->p[c];
    return (Jet){jittered(spot, x), spot->p ? t * spot->p[c] : 0,
                 spot->q ? t * spot->q[c] : 0, 0};
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
static Jet friction_law(Jet y, Real e)
{
    Real a = fabsl(y.f) / e, sign = copysignl(1, y.f);
    return a < 1 ? chain(y, y.f * y.f / e * (1 - a / 3), sign * a * (2 - a),
                         2 / e * (1 - a))
                 : chain(y, fabsl(y.f) - e / 3, sign, 0);
}

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
    Real s = gap(&before, contact, i, k, n).f;
    if (!(s < 1))
        return;
    Jet y = {.f = -spot->h * (n[0] * jittered(spot, it->v[1]) -
                              n[1] * jittered(spot, it->v[0]))};
    for (int axis = 0; axis < 2; axis++)
        y = plus(y, axis ? n[0] : -n[1],
                 it->node >= 0 ? between(spot, i, it->node, axis, true)
                               : coordinate(spot, 2 * i + axis, true));
    book(spot, sum,
         it->friction * contact->barrier.c / contact->barrier.d_hat *
             -(logl(s) + 1 - 1 / s),
         friction_law(y, e));
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

/* d^2/d_hat^2 of point p and edge s; where the edge is nearest, and n. */
static Jet parted(Spot *spot, const SelfContact *self, int p, int s, Real *r,
                  Real n[2])
{
    const int *end = spot->at->system->e + 2 * s;
    Jet d[2], e[2], q[2], length2, along, d2;
    for (int axis = 0; axis < 2; axis++) {
        e[axis] = between(spot, end[1], end[0], axis, false);
        q[axis] = between(spot, p, end[0], axis, false);
        d[axis] = q[axis];
    }
    along = plus(times(q[0], e[0]), 1, times(q[1], e[1]));
    length2 = plus(times(e[0], e[0]), 1, times(e[1], e[1]));
    Real l = length2.f;
    *r = fminl(fmaxl(along.f / l, 0), 1);
    if (*r == 1)
        for (int axis = 0; axis < 2; axis++)
            d[axis] = between(spot, p, end[1], axis, false);
    d2 = plus(times(d[0], d[0]), 1, times(d[1], d[1]));
    if (*r > 0 && *r < 1) {
        Jet side = plus(times(e[0], q[1]), -1, times(e[1], q[0]));
        d2 = times(times(side, side),
                   chain(length2, 1 / l, -1 / (l * l), 2 / (l * l * l)));
    }
    for (int axis = 0; axis < 2; axis++)
        n[axis] = (q[axis].f - *r * e[axis].f) / sqrtl(d2.f);
    return plus((Jet){0}, 1 / ((Real)self->d_hat * self->d_hat), d2);
}

/* mu F f0(y), F and t of x_n: friction.h */
static void rubbing(Spot *spot, Jet *sum, const SelfContact *self, int p, int s)
{
    const System *system = spot->at->system;
    const Term *term = system_find_term(system, &self_friction_energy);
    const int *end = system->e + 2 * s;
    if (!term || !spot->at->u)
        return;
    Place start = *spot->at;
    Spot before = {.at = &start, .h = spot->h, .jitter = spot->jitter};
    Real n[2], r, e = ((const Friction *)term->data)->slip_speed * spot->h;
    start.x = start.x_n;
    Real S = parted(&before, self, p, s, &r, n).f;
    Jet y = {0};
    if (!(S < 1))
        return;
    for (int axis = 0; axis < 2; axis++) {
        Real t = axis ? n[0] : -n[1];
        y = plus(y, t, coordinate(spot, 2 * p + axis, true));
        y = plus(y, -t * (1 - r), coordinate(spot, 2 * end[0] + axis, true));
        y = plus(y, -t * r, coordinate(spot, 2 * end[1] + axis, true));
    }
    book(spot, sum,
         self->friction * self->c / self->d_hat * 2 * sqrtl(S) *
             -(logl(S) + 1 - 1 / S),
         friction_law(y, e));
}

/* Whether a point and an edge are so far from each other that there is nothing:
 * most of them are.  x [2n] m */
static bool is_far(const double *x, int p, const int end[2], double d_hat)
{
    const double *a = x + 2 * end[0], *b = x + 2 * end[1];
    double most = 1.001 * d_hat;
    for (int c = 0; c < 2; c++) {
        double y = x[2 * p + c];
        if ((y > a[c] + most && y > b[c] + most) ||
            (y < a[c] - most && y < b[c] - most))
            return true;
    }
    return false;
}

/* c f(d^2/d_hat^2): self_contact.h */
static void meetings(Spot *spot, Jet *sum, const void *data)
{
    const System *system = spot->at->system;
    const SelfContact *self = self_contact_of(system);
    size_t size = 2 * (size_t)system->nodes;
    double *x = malloc(size * sizeof *x);
    Real n[2], r;
    CHECK(x != NULL);
    for (size_t i = 0; i < size; i++) /* friction is of the step's start */
        x[i] = data == self ? (double)coordinate(spot, (int)i, false).f
                            : spot->at->x_n[i];
    for (int k = 0; k < self->boundary.edges; k++)
        for (int i = 0; i < self->boundary.points; i++) {
            int s = self->boundary.box[k].edge, p = self->boundary.point[i];
            const int *end = system->e + 2 * s;
            if (p == end[0] || p == end[1] || is_far(x, p, end, self->d_hat))
                continue;
            if (data == self)
                barrier(spot, sum, self->c, parted(spot, self, p, s, &r, n));
            else
                rubbing(spot, sum, self, p, s);
        }
    free(x);
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
} formulas[] = {{&mass_spring_energy, springs},
                {&plastic_energy, springs},
                {&contact_energy, contacts},
                {&friction_energy, contacts},
                {&cell_energy, cells},
                {&central_field, pulls},
                {&hand_energy, pulls},
                {&neo_hookean_energy, solids},
                {&self_contact_energy, meetings},
                {&self_friction_energy, meetings}};

static Jet energy_there(Spot *spot, const TermKind *only)
{
    const System *system = spot->at->system;
    Jet sum = {0};
    spot->size = (Jet){0};
    for (int i = 0; i < system->terms; i++) {
        const TermKind *kind = system->term[i].kind;
        for (size_t f = 0; f < sizeof formulas / sizeof *formulas; f++)
            if (formulas[f].kind == kind && (!only || kind == only))
                formulas[f].formula(spot, &sum, system->term[i].data);
    }
    spot->size = plus((Jet){0}, spot->at->w, spot->size);
    return plus((Jet){0}, spot->at->w, sum);
}

/* Averaged: two points of Gauss's rule are exact up to degree 3. */
Jet oracle_energy(Spot *spot, const TermKind *only)
{
    static const Real gauss[2] = {0.2113248654051871177454256L,
                                  0.7886751345948128822545744L};
    if (!spot->averaged)
        return energy_there(spot, only);
    Place x_n = *spot->at;
    Spot start = {.at = &x_n, .h = spot->h};
    Jet sum = {0}, size = {0};
    x_n.x = x_n.x_n;
    Real before = energy_there(&start, only).f;
    for (int i = 0; i < 2; i++) {
        spot->t = gauss[i];
        Jet there = energy_there(spot, only);
        there.f -= before;
        sum = plus(sum, 1 / (2 * spot->t), there);
        size = plus(size, 1 / (2 * spot->t), spot->size);
    }
    spot->t = 0;
    spot->size = size;
    return sum;
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
    Spot spot = {.at = &at, .h = 1, .p = p, .q = q};
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

/* ---- what must not be passed --- */

/* Twice the area of nodes a, b, c. */
static Real area_of(const double *x, int a, int b, int c)
{
    const double *o = x + 2 * a, *p = x + 2 * b, *q = x + 2 * c;
    return ((Real)p[0] - o[0]) * ((Real)q[1] - o[1]) -
           ((Real)p[1] - o[1]) * ((Real)q[0] - o[0]);
}

long exact_crossings(const System *system, const double *x)
{
    const SelfContact *self = self_contact_of(system);
    long count = 0;
    for (int k = 0; self && k < self->boundary.edges; k++)
        for (int l = 0; l < k; l++) {
            const int *e = system->e + 2 * self->boundary.box[k].edge;
            const int *f = system->e + 2 * self->boundary.box[l].edge;
            count +=
                area_of(x, e[0], e[1], f[0]) * area_of(x, e[0], e[1], f[1]) <
                    0 &&
                area_of(x, f[0], f[1], e[0]) * area_of(x, f[0], f[1], e[1]) < 0;
        }
    return count;
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
    const Cells *cells = system_data(system, &cell_energy);
    const NeoHookean *solid = solid_of(system);
    Place at = place_at(system, x, NULL, x);
    Spot spot = {.at = &at};
    double smallest = INFINITY;
    Jet J;
    for (int t = 0; cells && t < cells->triangles; t++)
        if (triangle(&spot, cells, t, &J))
            smallest = fmin(smallest, (double)J.f);
    for (int t = 0; solid && t < solid->triangles; t++) {
        const int *node = solid->node[t];
        smallest =
            fmin(smallest, (double)(area_of(x, node[0], node[1], node[2]) /
                                    (2 * solid->area)));
    }
    return smallest;
}
