/* stress_scenes.c - random scenes, each a command line that can be run again;
 * and cases that have a name: places where floating point is known to bite.
 */
#include "stress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>

/* Seconds that one scene may take before it counts as one that never ends. */
enum { SCENE_LIMIT = 120 };

/* What a kind of scene may have: a part of the command line in which (a b c)
 * is one of these words, [a b] a number between, <a b> one between by powers
 * of ten. */
static const struct Draw {
    const char *kinds; /* letters of stress.h */
    int one_in;        /* so often */
    const char *part;
} draws[] = {
    {"sfwmnk", 1, "square"},
    {"c", 1, "(drop slope squeeze dent)"},
    {"t", 1, "tear"},
    {"s", 1, " --segments (1 2 3)"},
    {"f", 1, " --segments (1 2 3 4)"},
    {"k", 1, " --segments (1 2 2 3)"},
    {"ctw", 1, " --segments (1 2 3 4 5 6)"},
    {"mn", 1, " --segments (1 1 2 2 3 4 6 8) --side 0.9"},
    {"b", 1, "bend --segments 16"},
    {"s", 1, " --stiffness <1e-3 1e15>"},
    {"f", 2, " --stiffness <1e2 1e9>"},
    {"ctbwm", 1, " --stiffness <1e3 1e8>"},
    {"s", 1, " --density <1e-9 1e6>"},
    {"f", 1, " --density <1e-9 1e6>"},
    {"s", 2, " --side <1e-3 1e3>"},
    {"s", 1, " --timestep <1e-6 1e6>"},
    {"f", 1, " --timestep <1e-4 1e4>"},
    {"ctbwmn", 1, " --timestep <3e-4 1>"},
    {"s", 1, " --stretch <0.01 30>"},
    {"s", 8, " --stretch (-1 0 1)"},
    {"f", 1, " --stretch <0.01 10>"},
    {"f", 6, " --stretch 0"},
    {"w", 1, " --stretch [0.6 1.5]"},
    {"n", 1, " --material neo-hookean --young <1e3 1e7> --poisson [0 0.48]"},
    {"k", 1, " --material neo-hookean --young <1e3 1e13> --poisson [0 0.48]"},
    {"k", 1, " --density <1e-6 1e3> --timestep <1e-4 1>"},
    {"k", 1, " --stretch [0.05 3] --turn [0 360] --tolerance <1e-9 1e-2>"},
    {"k", 4, " --velocity [-9 9],[-9 9]"},
    {"k", 4, " --gravity 9.81"},
    {"k", 4, " --pin (0 left top-corners)"},
    {"mn", 1, " --self-contact on"},
    {"m", 2, " --cells on"},
    {"mn", 1, " --body 0,0,[0 360],[-9 9],[-9 9],[0.8 1.2],[0.8 1.2]"},
    {"mn", 1, " --body 1.6,[-0.5 0.5],[0 360],-<0.1 50>,[-9 9]"},
    {"mn", 2, " --body [-0.5 0.5],1.6,[0 360],[-9 9],-<0.1 50>"},
    {"mn", 3, " --body -1.6,[-0.5 0.5],[0 360],<0.1 50>,[-9 9]"},
    {"mn", 4, " --body [-0.3 0.3],3.2,[0 360],0,-<0.1 50>,[0.8 1.2],[0.8 1.2]"},
    {"mn", 4, " --body 3.2,[-0.3 0.3],0,-<0.1 50>,0"},
    {"mn", 2, " --ground [-0.3 0.3],1,0,-2.4 --friction [0 1.5]"},
    {"mn", 3, " --ceiling 4.5,-<0.1 20>,[1 3]"},
    {"mn", 2, " --self-friction [0 1.5]"},
    {"mn", 4, " --pin (0 left top-corners bottom)"},
    {"mn", 2, " --gravity 9.81"},
    {"m", 3, " --tear <0.03 1>"},
    {"s", 2, " --tolerance <1e-9 1e3>"},
    {"f", 3, " --tolerance <1e-8 1e-2>"},
    {"ctbwmn", 1, " --tolerance <1e-8 1e-2>"},
    {"s", 4, " --pin (0 1,2 left top-corners)"},
    {"s", 2, " --projection (clamp none abs on-demand)"},
    {"ctbwmn", 4, " --projection clamp"},
    {"s", 1, " --solver (newton multigrid)"},
    {"s", 2,
     " --integrator (forward-euler symplectic-euler verlet bdf2 midpoint "
     "sdirk2)"},
    {"sw", 2, " --turn [0 360]"},
    {"s", 4, " --velocity [-9 9],<0.01 1e3>"},
    {"cw", 1, " --velocity [-30 30],-<0.1 100>"},
    {"w", 1, " --gravity 9.81 --slip-speed <1e-4 1> --cells on"},
    {"w", 1, " --ground [-0.3 0.3],1,0,-1.6 --ground 1,[-0.3 0.3],-1.6,0"},
    {"w", 1, " --ball [-0.5 0.5],-1.8,0.6"},
    {"cbw", 1, " --friction [0 1.5]"},
    {"ctb", 3, " --cells (on on off)"},
    {"f", 1, " --yield <1e-4 0.5>"},
    {"f", 2, " --hardening <1e-6 2>"}, /* else 0 */
    {"ctbw", 3, " --yield <0.01 0.5> --hardening [0 2]"},
    {"f", 8, " --tear <0.03 3>"},
    {"ctbw", 3, " --tear <0.03 1>"},
    {"f", 4, " --damping <1e-5 10>"},
    {"ctbw", 3, " --damping <1e-5 10>"},
    {"cbwmn", 3, " --barrier <1e-4 0.004>,<1e3 1e8>"},
    {"l", 1,
     "square --segments (5 9 16 17 24 33 40 54) --stretch <0.1 3> --timestep "
     "<1e-4 0.1> --stiffness <1e2 1e9> --tolerance <1e-5 1> --integrator "
     "(backward-euler bdf2 midpoint sdirk2) --solver multigrid"},
    {"l", 3, " --pin top --gravity 5"},
    {"s", 2, " shaken [1 1e6]"}};

/* One of the words up to ')'. */
static size_t draw_word(Random *random, const char *words, char *text)
{
    size_t size = strcspn(words, ")");
    int count = 1;
    for (size_t i = 0; i < size; i++)
        count += words[i] == ' ';
    int chosen = random_below(random, count);
    for (; chosen > 0; chosen--)
        words += strcspn(words, " ") + 1;
    size_t length = strcspn(words, " )");
    memcpy(text, words, length);
    return length;
}

/* Appends this part to a line. */
static void draw_part(Random *random, const char *part, char *line)
{
    char *end = line + strlen(line);
    for (; *part; part++) {
        char *rest, bracket = *part;
        if (bracket == '(') {
            end += draw_word(random, part + 1, end);
            part = strchr(part, ')');
        } else if (bracket == '[' || bracket == '<') {
            double low = strtod(part + 1, &rest), high = strtod(rest, &rest);
            end +=
                sprintf(end, "%.3g",
                        bracket == '[' ? random_uniform(random, low, high)
                                       : random_logarithmic(random, low, high));
            part = rest;
        } else {
            *end++ = bracket;
        }
        *end = '\0';
    }
}

void stress_line(const char *kinds, uint64_t seed, long number,
                 char line[STRESS_LINE])
{
    Random random = {seed * 1000003 + (uint64_t)number};
    char kind = kinds[number % (long)strlen(kinds)];
    line[0] = '\0';
    for (size_t i = 0; i < sizeof draws / sizeof *draws; i++)
        if (strchr(draws[i].kinds, kind) &&
            random_below(&random, draws[i].one_in) == 0)
            draw_part(&random, draws[i].part, line);
}

/* Masses, springs, positions and velocities of no square: each over some
 * powers of ten, springs that hardly are, nodes on a line, in one point or in
 * pairs, folded, some a million times further out than others, or far away. */
static void shake(uint64_t seed, TimeIntegrator *run)
{
    Random random = {seed * 0x9e3779b97f4a7c15u};
    System *system = run->system;
    double size = hypot(run->x[0], run->x[1]) + 1e-3;
    double m_spread = random_below(&random, 2) ? 1 : 1e6;
    double k_spread = random_below(&random, 2) ? 1 : 1e9;
    double near = random_below(&random, 2) ? 1.5 : 30;
    double away = random_below(&random, 8)
                      ? 0
                      : size * random_logarithmic(&random, 1, 1e7);
    double speed = size / run->h * random_logarithmic(&random, 1e-6, 1);
    int shape = random_below(&random, 8), missing = random_below(&random, 4);
    for (int i = 0; i < 2 * system->nodes; i++) {
        bool pinned = system->pinned[i / 2];
        if (shape == 1)
            run->x[i] = size * random_uniform(&random, -1, 1);
        if (shape == 2 && i % 2)
            run->x[i] = 0;
        if (shape == 3 && random_below(&random, 3) == 0)
            run->x[i] = run->x[i % 2];
        if (shape == 4)
            run->x[i] = fabs(run->x[i]);
        if (shape == 5)
            run->x[i] *= i / 2 % 2 ? 1e3 : 1e-3;
        if (shape == 6 && i % 4 > 1)
            run->x[i] = run->x[i - 2];
        run->x[i] += away;
        run->v[i] += pinned ? 0 : speed * random_uniform(&random, -1, 1);
        if (i % 2)
            system->m[i / 2] *= random_logarithmic(&random, 1, m_spread);
    }
    for (int s = 0; s < system->springs; s++) {
        system->l2[s] *= random_logarithmic(&random, 1 / near, near);
        system->k[s] *= random_logarithmic(&random, 1, k_spread);
        if (missing == 1 && random_below(&random, 2))
            system->k[s] *= 1e-30;
    }
}

/* Every run of it, some steps each. */
static Verdict run_steps(Simulation *simulation, uint64_t shaken, int steps,
                         Tally *tally, char *reason)
{
    Verdict worst = VERDICT_CONVERGED;
    for (int r = 0; r < simulation->runs; r++) {
        TimeIntegrator *run = &simulation->run[r];
        Watch watch;
        if (shaken > 0)
            shake(shaken, run);
        if ((shaken > 0 && watch_restart(run)) ||
            !watch_create(run, tally, &watch))
            return snprintf(reason, 512, "no restart"), VERDICT_WRONG;
        for (int step = 0; step < steps && worst != VERDICT_WRONG; step++) {
            Verdict verdict = watch_step(&watch);
            worst = verdict > worst ? verdict : worst;
            if (verdict == VERDICT_WRONG)
                memcpy(reason, watch.reason, sizeof watch.reason);
            if (watch.status && !status_is_unconverged(watch.status))
                break;
        }
        watch_free(&watch);
    }
    return worst;
}

Verdict stress_run(const char *line, int steps, Tally *tally, char *reason)
{
    char known[STRESS_LINE];
    Simulation simulation;
    snprintf(known, sizeof known, "%s", line);
    char *word = strstr(known, " shaken ");
    uint64_t shaken = word ? (uint64_t)strtod(word + 8, NULL) : 0;
    if (word)
        *word = '\0';
    simulation_from_line(known, NULL, NULL, &simulation);
    Verdict verdict = run_steps(&simulation, shaken, steps, tally, reason);
    simulation_free(&simulation);
    tally->cases++;
    tally->wrong += verdict == VERDICT_WRONG;
    return verdict;
}

char stress_present[STRESS_LINE];

void stress_limit(long seconds)
{
    const struct itimerval limit = {.it_value = {.tv_sec = seconds}};
    setitimer(ITIMER_PROF, &limit, NULL);
}

bool stress_scenes(const char *kinds, uint64_t seed, long count, int steps,
                   Tally *tally, char *reason)
{
    Verdict verdict = VERDICT_CONVERGED;
    for (long i = 0; i < count && verdict != VERDICT_WRONG; i++) {
        stress_line(kinds, seed, i, stress_present);
        stress_limit(SCENE_LIMIT);
        verdict = stress_run(stress_present, steps, tally, reason);
    }
    stress_limit(0);
    return verdict != VERDICT_WRONG;
}

/* ---- cases that have a name ---------------------------------------------- */

/* So many steps of a command line, with one solver or the other; where it
 * begins with '!' all must converge. */
typedef struct Line {
    int steps;
    const char *line; /* NULL: the end of a list */
} Line;

static bool run_line(Tally *tally, char *reason, Line row, int solver)
{
    char line[STRESS_LINE];
    bool converges = row.line[0] == '!';
    snprintf(line, sizeof line, "%s --solver %s", row.line + converges,
             solver_name(solver));
    Verdict verdict = stress_run(line, row.steps, tally, reason);
    if (verdict == VERDICT_REPORTED && converges)
        snprintf(reason, 512, "it does not converge");
    if (verdict == VERDICT_WRONG || (verdict && converges)) {
        strncat(strncat(reason, ": ", 3), line, 511 - strlen(reason));
        return false;
    }
    return true;
}

static bool extreme_squares(Tally *tally, char *reason)
{
    static const Line rows[] = {
        {5, "!--timestep 1e3"},
        {5, "!--timestep 1e3 --stretch 0.3"},
        {5, "!--timestep 1e3 --stretch 100"},
        {5, "!--timestep 1e3 --segments 1"},
        {5, "!--stiffness 1e-6"},
        {5, "!--stiffness 1e15"},
        {5, "!--stiffness 1e-6 --stretch 0.1"},
        {5, "!--stiffness 1e15 --stretch 0.9"},
        {5, "--stretch 1e6"},
        {5, "--stretch 1e-6"},
        {5, "--stretch 0"},
        {5, "--stretch -1.4"},
        {5, "--stretch 1e3"},
        {5, "--stretch 0.1"},
        /* h^2 k/m from 1e22 to 1e31: the factor needs a shift or is not exact,
         * and conjugate gradients break down; curvatures are rounded to 0 */
        {4, "--segments 2 --density 1 --stiffness 1e15 --stretch 20 "
            "--timestep 1e6"},
        {4, "--segments 2 --side 0.04096289353718123 --density "
            "0.075213809795248179 --stiffness 3099333258.9627662 --stretch "
            "1.9217744152891494 --timestep 34289.345836827328 --tolerance "
            "0.22234558596351073 --integrator midpoint"},
        {1, "--segments 2 --density 1e-6 --stiffness 1e13 --timestep 1e6"},
        {50, "!--segments 1"},
        {50, "!--segments 1 --stretch 0.2"},
        {50, "!--segments 1 --timestep 1"},
        {0, NULL},
    };
    for (const Line *row = rows; row->line; row++)
        if (!run_line(tally, reason, *row, SOLVER_NEWTON) ||
            !run_line(tally, reason, *row, SOLVER_MULTIGRID))
            return false;
    return true;
}

static bool large_squares(Tally *tally, char *reason)
{
    static const Line rows[] = {
        {40, "--segments 33"},
        {20, "--segments 64"},
        {6, "--segments 97 --stretch 0.7"},
        {10, "--segments 128"},
        {6, "--segments 128 --timestep 0.0166"},
        {8, "--segments 48 --stretch 2.5"},
        {5, "--segments 48 --stretch 0.5 --timestep 0.02"},
        {4, "--segments 40 --stretch 0.1 --timestep 0.1"},
        {5, "--segments 40 --stiffness 1e9 --stretch 1.1"},
        {8, "--segments 40 --stiffness 1e3 --timestep 0.1"},
        {12, "--segments 40 --integrator bdf2"},
        {12, "--segments 40 --integrator midpoint --stretch 1.2"},
        {8, "--segments 40 --integrator sdirk2"},
        {10, "--segments 40 --tolerance 1e-6"},
        {14, "--segments 40 --tolerance 1"},
        {15, "--segments 36 --gravity 9.81 --pin top-corners --stretch 1 "
             "--timestep 0.01 --stiffness 1e4"},
        {12, "--segments 35 --pin left --stretch 1.3"},
        {6, "--segments 33 --side 1e-3 --density 1e-3 --stiffness 1e-3"},
        {6, "--segments 33 --side 1e3 --stiffness 1e9"},
        {0, NULL},
    };
    for (const Line *row = rows; row->line; row++)
        if (!run_line(tally, reason, *row, SOLVER_MULTIGRID))
            return false;
    return true;
}

/* Every integrator, gently and hard. */
static bool every_integrator(Tally *tally, char *reason)
{
    for (int i = 0; integrator_methods[i].name; i++)
        for (int way = 0; way < 4; way++) {
            char line[128];
            snprintf(line, sizeof line, "--integrator %s --timestep %s",
                     integrator_methods[i].name, way < 2 ? "0.05" : "1e-3");
            if (!run_line(tally, reason, (Line){20, line}, way % 2))
                return false;
        }
    return true;
}

/* A default square that is kicked at random every 50 steps; residuals are
 * computed again of some steps. */
static bool many_steps(Tally *tally, char *reason)
{
    Random random = {7};
    Simulation simulation;
    Watch watch;
    simulation_from_line("--stretch 1.4", NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    bool good = watch_create(run, tally, &watch);
    for (long step = 0; step < 300000 && good; step++) {
        for (size_t i = 0; step % 50 == 0 && i < run->size; i++)
            run->v[i] += random_uniform(&random, -3, 3);
        watch.residuals = step % 500 < 3;
        good = watch_step(&watch) != VERDICT_WRONG;
    }
    memcpy(reason, watch.reason, sizeof watch.reason);
    watch_free(&watch);
    simulation_free(&simulation);
    tally->cases++;
    tally->wrong += !good;
    return good;
}

const StressCase stress_cases[] = {
    {"extreme squares", false, extreme_squares},
    {"large squares", true, large_squares},
    {"every integrator", false, every_integrator},
    {"many steps", true, many_steps},
    {NULL, false, NULL},
};
