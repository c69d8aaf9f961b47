/* stress_flow.c - random squares of springs that flow, each a command line that
 * can be run again: half of them without hardening, densities from 1e-9 to 1e6
 * kg/m^2, time steps to 1e4 s.  E, computed again as plasticity.h and damping.h
 * write it, is raised by no update and by no step.
 */
#include "stress.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/damping.h"
#include "model/plasticity.h"

enum { FLOW_STEPS = 2, MOST_NODES = 25 };

/* An option, how often, and where its numbers lie, in powers of ten; or now
 * and then its border. */
static const struct Draw {
    const char *option;
    int one_in;
    double low, high;
    int border_in; /* 0: never */
    double border;
} draws[] = {
    {"--yield", 1, 1e-4, 0.5, 0, 0},     {"--hardening", 2, 1e-6, 2, 0, 0},
    {"--density", 1, 1e-9, 1e6, 0, 0},   {"--timestep", 1, 1e-4, 1e4, 0, 0},
    {"--stretch", 1, 0.01, 10, 6, 0},    {"--stiffness", 2, 1e2, 1e9, 0, 0},
    {"--damping", 4, 1e-5, 10, 0, 0},    {"--tear", 8, 0.03, 3, 0, 0},
    {"--tolerance", 3, 1e-8, 1e-2, 0, 0}};

static void flow_line(uint64_t seed, long number, char *line, size_t size)
{
    Random random = {seed * 1000003 + (uint64_t)number};
    size_t used = (size_t)snprintf(line, size, "square --segments %d",
                                   1 + random_below(&random, 4));
    for (size_t i = 0; i < sizeof draws / sizeof *draws; i++) {
        const struct Draw *it = &draws[i];
        double value = random_logarithmic(&random, it->low, it->high);
        if (it->border_in && random_below(&random, it->border_in) == 0)
            value = it->border;
        if (random_below(&random, it->one_in) == 0)
            used += (size_t)snprintf(line + used, size - used, " %s %.3g",
                                     it->option, value);
    }
}

/* |d|^2/l2 - 1 at x_n + u, u NULL: 0; or at x. */
static Wide wide_strain(const System *system, int s, const double *x_n,
                        const double *u)
{
    Wide sum = 0;
    for (int c = 0; c < 2; c++) {
        int i = 2 * system->e[2 * s] + c, j = 2 * system->e[2 * s + 1] + c;
        Wide d = (Wide)x_n[i] - x_n[j] + (u ? (Wide)u[i] - u[j] : 0);
        sum += d * d;
    }
    return sum / system->l2[s] - 1;
}

/* E of a step with h at x + u, u NULL: at x; u_step tells the masses. */
static Wide flow_energy(const Iterate *at, double h, const double *x,
                        const double *u, const double *u_step)
{
    const System *system = at->E.system;
    const Plasticity *flow = plasticity_of(system);
    const Damping *damped = damping_of(system);
    Wide sum = 0;
    for (int s = 0; s < system->springs; s++) {
        Wide e = wide_strain(system, s, x, u), rate = 0;
        if (damped)
            rate = e - wide_strain(system, s, at->E.x_n, NULL);
        e -= flow->ep[s];
        Wide size = e < 0 ? -e : e;
        Wide Y = flow->yield + (Wide)flow->hardening * flow->kappa[s];
        Wide over = size > Y ? size - Y : 0;
        Wide twice = e * e - over * over / (1 + (Wide)flow->hardening) +
                     (damped ? damped->eta / (Wide)h * rate * rate : 0);
        sum += (Wide)h * h * system->k[s] * system->l2[s] * twice / 2;
    }
    for (int i = 0; i < 2 * system->nodes; i++) {
        Wide away = (u_step ? (Wide)u_step[i] : 0) - at->E.u_tilde[i];
        sum += (Wide)system->m[i / 2] * away * away / 2;
    }
    return sum;
}

/* What rounding of the gradient at x_n + u makes of E on the way by p: forces
 * to an ulp, and what an ulp of x does to them. */
static double flow_noise(const Iterate *at, double h, const double *u,
                         const double *to)
{
    const System *system = at->E.system;
    const Plasticity *flow = plasticity_of(system);
    const Damping *damped = damping_of(system);
    double sum = 0, theta = damped ? damped->eta / h : 0;
    for (int s = 0; s < system->springs; s++) {
        double E = (double)wide_strain(system, s, at->E.x_n, u), x = 0, p = 0;
        double Y = flow->yield + flow->hardening * flow->kappa[s];
        double part = flow->hardening / (1 + flow->hardening);
        double size = fabs(E - flow->ep[s]), over = fmax(size - Y, 0);
        double bend = (over > 0 ? part : 1) + theta, d2 = E + 1;
        double pull = size - over + part * over;
        if (damped)
            pull += theta * fabs(E - damped->E_n[s]);
        for (int c = 0; c < 4; c++) {
            int i = 2 * system->e[2 * s + c / 2] + c % 2;
            x += fabs(at->E.x_n[i] + u[i]);
            p += fabs(to[i] - u[i]);
        }
        sum += 2 * h * h * system->k[s] * p *
               (pull * sqrt(d2 * system->l2[s]) + (2 * bend * d2 + pull) * x);
    }
    for (int i = 0; i < 2 * system->nodes; i++)
        sum += system->m[i / 2] * (fabs(u[i]) + fabs(at->E.u_tilde[i])) *
               fabs(to[i] - u[i]);
    return DBL_EPSILON * sum;
}

/* E at the last iterate u and at the start of the step. */
typedef struct Fall {
    Simulation simulation;
    double u[2 * MOST_NODES], noise;
    Wide E, start;
    long updates;
    bool wrong;
    double from, to;
} Fall;

/* 1e-9 of E, and ten times what rounding of the gradients since then, and of
 * x = x_n + u, do to it. */
static void judge_fall(Fall *fall, Wide before, double noise)
{
    const TimeIntegrator *run = &fall->simulation.run[0];
    const Iterate *at = &run->newton->at;
    Wide E = flow_energy(at, run->h, at->E.x_n, at->u, at->u);
    Wide rise = E - before, allowed = (E + before) * 1e-9L + 10 * noise;
    if (rise > allowed) {
        Wide rounded = flow_energy(at, run->h, at->x, NULL, at->u) - E;
        allowed += 10 * (rounded < 0 ? -rounded : rounded);
    }
    if (!(rise <= allowed) && !fall->wrong) {
        fall->wrong = true;
        fall->from = (double)before;
        fall->to = (double)E;
    }
    fall->E = E;
}

static bool see_update(void *user, const NewtonRecord *record)
{
    Fall *fall = user;
    const TimeIntegrator *run = &fall->simulation.run[0];
    const Iterate *at = &run->newton->at;
    if (record->iteration <= 0)
        fall->E = fall->start = flow_energy(at, run->h, at->E.x_n, NULL, NULL);
    if (record->iteration <= 0) {
        memset(fall->u, 0, sizeof fall->u);
        fall->noise = 0;
    }
    if (record->iteration < 0)
        return true;
    double noise = flow_noise(at, run->h, fall->u, at->u);
    fall->noise += noise;
    judge_fall(fall, fall->E, noise);
    judge_fall(fall, fall->start, fall->noise);
    memcpy(fall->u, at->u, 2 * (size_t)run->system->nodes * sizeof *fall->u);
    fall->updates++;
    return true;
}

/* This many scenes; the first that is wrong ends them. */
static bool flow_scenes(long count, Tally *tally, char *reason)
{
    static Fall fall;
    char line[512];
    for (long i = 0; i < count; i++) {
        flow_line(stress_contact_seed, i, line, sizeof line);
        memset(&fall, 0, sizeof fall);
        simulation_from_line(line, see_update, &fall, &fall.simulation);
        tally->cases++;
        for (int step = 0; step < FLOW_STEPS && !fall.wrong; step++) {
            Status status = simulation_step(&fall.simulation);
            tally->steps[status ? VERDICT_REPORTED : VERDICT_CONVERGED]++;
            tally->statuses[status]++;
            if (status && !status_is_unconverged(status))
                fall.wrong = true;
        }
        tally->judged += fall.updates;
        simulation_free(&fall.simulation);
        if (!fall.wrong)
            continue;
        snprintf(reason, 512, "%.400s: E from %.12g to %.12g", line, fall.from,
                 fall.to);
        tally->wrong++;
        return false;
    }
    return true;
}

bool stress_flow(Tally *tally, char *reason)
{
    return flow_scenes(20000, tally, reason);
}

bool stress_flow_small(Tally *tally, char *reason)
{
    return flow_scenes(120, tally, reason);
}
