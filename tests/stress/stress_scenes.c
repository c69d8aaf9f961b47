/* stress_scenes.c - random scenes, each a command line that can be run
 * again, and named cases in which rounding is large. */
#include "stress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>

/* Processor time after which a scene counts as endless, s */
enum { SCENE_TIME_LIMIT = 120 };

bool stress_read_rows(const char *name, bool (*take)(void *user, char *row),
                      void *user)
{
    char row[2 * STRESS_LINE_SIZE];
    bool good = true, below = false;
    FILE *file = fopen("tests/data/stress.txt", "r");
    CHECK(file != NULL);
    while (good && fgets(row, sizeof row, file)) {
        row[strcspn(row, "\n")] = '\0';
        if (row[0] == '=')
            below = strcmp(row + 2, name) == 0;
        else if (below && row[0] && row[0] != '#')
            good = take(user, row);
    }
    fclose(file);
    return good;
}

/* Parts of random command lines: the rows below "= draw" of stress.txt */
static struct CommandPart {
    char kinds[16]; /* kinds of scenes that may have the part (stress.h) */
    int rarity;     /* 1/rarity: probability that a scene has the part */
    char format[STRESS_LINE_SIZE];
} command_parts[96];
static int command_part_count;

static bool store_command_part(void *unused, char *row)
{
    struct CommandPart *part = &command_parts[command_part_count++];
    (void)unused;
    CHECK(command_part_count <= 96);
    CHECK(sscanf(row, "%15s %d %511[^\n]", part->kinds, &part->rarity,
                 part->format) == 3);
    return true;
}

/* Copies a random word of a list before a ')'. Returns the word's length. */
static size_t copy_random_word(Random *random, const char *words, char *text)
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

/* Appends a part to a line: (a b) is one of the words, [low high] a uniform
 * random number, <low high> a logarithmic one. */
static void append_command_part(Random *random, const char *part, char *line)
{
    char *end = strcat(line, line[0] ? " " : "") + strlen(line);
    for (; *part; part++) {
        char *rest, bracket = *part;
        if (bracket == '(') {
            end += copy_random_word(random, part + 1, end);
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

/* Makes the command line of the random scene with this number. */
static void make_random_command(const char *kinds, uint64_t seed, long number,
                                char line[STRESS_LINE_SIZE])
{
    Random random = {seed * 1000003 + (uint64_t)number};
    char kind = kinds[number % (long)strlen(kinds)];
    line[0] = '\0';
    if (command_part_count == 0)
        stress_read_rows("draw", store_command_part, NULL);
    for (int i = 0; i < command_part_count; i++)
        if (strchr(command_parts[i].kinds, kind) &&
            random_below(&random, command_parts[i].rarity) == 0)
            append_command_part(&random, command_parts[i].format, line);
}

/* Changes masses, springs, positions and velocities at random, each over some
 * powers of ten: a spring hardly has stiffness; nodes lie on a line, in a
 * point, in pairs, folded, or a million times further out than others. */
static void perturb_start(uint64_t seed, TimeIntegrator *run)
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
        bool pinned = system->is_pinned[i / 2];
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

/* Makes and tests `steps` steps of every run, after a perturbation if shaken is
 * not 0. Returns the worst verdict. */
static StepVerdict run_steps(Simulation *simulation, uint64_t shaken, int steps,
                             VerdictTally *tally, char *reason)
{
    StepVerdict worst = VERDICT_CONVERGED;
    for (int r = 0; r < simulation->runs; r++) {
        TimeIntegrator *run = &simulation->run[r];
        RunWatch watch;
        if (shaken > 0)
            perturb_start(shaken, run);
        if ((shaken > 0 && restart_watched_run(run)) ||
            !watch_create(run, tally, &watch))
            return snprintf(reason, 512, "no restart"), VERDICT_WRONG;
        for (int step = 0; step < steps && worst != VERDICT_WRONG; step++) {
            StepVerdict verdict = make_judged_step(&watch);
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

StepVerdict stress_run_line(const char *line, int steps, VerdictTally *tally,
                            char *reason)
{
    char known[STRESS_LINE_SIZE];
    Simulation simulation;
    snprintf(known, sizeof known, "%s", line);
    char *word = strstr(known, " shaken ");
    uint64_t shaken = word ? (uint64_t)strtod(word + 8, NULL) : 0;
    if (word)
        *word = '\0';
    simulation_from_line(known, NULL, NULL, &simulation);
    StepVerdict verdict = run_steps(&simulation, shaken, steps, tally, reason);
    simulation_free(&simulation);
    tally->cases++;
    tally->wrong_cases += verdict == VERDICT_WRONG;
    return verdict;
}

char stress_line[STRESS_LINE_SIZE];

void stress_set_time_limit(long seconds)
{
    const struct itimerval limit = {.it_value = {.tv_sec = seconds}};
    setitimer(ITIMER_PROF, &limit, NULL);
}

bool stress_run_scenes(const char *kinds, uint64_t seed, long count, int steps,
                       VerdictTally *tally, char *reason)
{
    StepVerdict verdict = VERDICT_CONVERGED;
    for (long i = 0; i < count && verdict != VERDICT_WRONG; i++) {
        make_random_command(kinds, seed, i, stress_line);
        stress_set_time_limit(SCENE_TIME_LIMIT);
        verdict = stress_run_line(stress_line, steps, tally, reason);
    }
    stress_set_time_limit(0);
    return verdict != VERDICT_WRONG;
}

/* ---- cases that have a name ---------------------------------------------- */

typedef struct CaseContext {
    VerdictTally *tally;
    char *reason;
    bool uses_each_solver;
} CaseContext;

/* Runs a row "STEPS ! LINE", which must converge; "STEPS ? LINE" need not. */
static bool run_file_row(void *user, char *row)
{
    static const char *const solvers[] = {" --solver multigrid",
                                          " --solver newton"};
    const CaseContext *context = user;
    char must, given[STRESS_LINE_SIZE], line[STRESS_LINE_SIZE + 32];
    int steps;
    CHECK(sscanf(row, "%d %c %511[^\n]", &steps, &must, given) == 3);
    for (int i = 0; i <= context->uses_each_solver; i++) {
        snprintf(line, sizeof line, "%s%s", given,
                 context->uses_each_solver ? solvers[i] : "");
        long judged = context->tally->judged_residuals;
        StepVerdict verdict =
            stress_run_line(line, steps, context->tally, context->reason);
        bool good = verdict != VERDICT_WRONG;
        if (good && must == '!') {
            good =
                !verdict && context->tally->judged_residuals - judged >= steps;
            snprintf(context->reason, 512, "it does not converge, or unjudged");
        }
        if (!good) {
            append(context->reason, 512, ": %s", line);
            return false;
        }
    }
    return true;
}

static bool run_extreme_squares(VerdictTally *tally, char *reason)
{
    return stress_read_rows("extreme squares", run_file_row,
                            &(CaseContext){tally, reason, true});
}

static bool run_large_squares(VerdictTally *tally, char *reason)
{
    return stress_read_rows("large squares", run_file_row,
                            &(CaseContext){tally, reason, false});
}

static bool run_earlier_failures(VerdictTally *tally, char *reason)
{
    return stress_read_rows("once wrong", run_file_row,
                            &(CaseContext){tally, reason, false});
}

/* Runs every integrator with a short and a long time step. */
static bool run_every_integrator(VerdictTally *tally, char *reason)
{
    for (int i = 0; integrator_methods[i].name; i++)
        for (int gently = 0; gently < 2; gently++) {
            char row[128];
            snprintf(row, sizeof row, "20 ? --integrator %s --timestep %s",
                     integrator_methods[i].name, gently ? "1e-3" : "0.05");
            if (!run_file_row(&(CaseContext){tally, reason, true}, row))
                return false;
        }
    return true;
}

/* Kicks a square at random every 50 steps; tests 3 residuals in 500 steps. */
static bool run_many_steps(VerdictTally *tally, char *reason)
{
    Random random = {7};
    Simulation simulation;
    RunWatch watch;
    simulation_from_line("--stretch 1.4", NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    bool good = watch_create(run, tally, &watch);
    for (long step = 0; step < 300000 && good; step++) {
        for (size_t i = 0; step % 50 == 0 && i < run->x_length; i++)
            run->v[i] += random_uniform(&random, -3, 3);
        watch.tests_residuals = step % 500 < 3;
        good = make_judged_step(&watch) != VERDICT_WRONG;
    }
    memcpy(reason, watch.reason, sizeof watch.reason);
    watch_free(&watch);
    simulation_free(&simulation);
    tally->cases++;
    tally->wrong_cases += !good;
    return good;
}

const StressCase stress_cases[] = {
    {"extreme squares", false, run_extreme_squares},
    {"large squares", true, run_large_squares},
    {"every integrator", false, run_every_integrator},
    {"once wrong", false, run_earlier_failures},
    {"many steps", true, run_many_steps},
    {NULL, false, NULL},
};
