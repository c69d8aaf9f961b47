#include "play/player.h"

#include <math.h>
#include <stdarg.h>

#include "base/clock.h"
#include "scenes/one_line.h"
#include "scenes/scene.h"

/* A quantity, its name in a column of its own. */
__attribute__((format(printf, 3, 4))) static void
print(FILE *file, const char *name, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(file, "%-20s", name);
    vfprintf(file, format, arguments);
    fputc('\n', file);
    va_end(arguments);
}

/* Who made the first run's last step, and why it was not multigrid. */
static void print_solver(FILE *file, const Simulation *simulation)
{
    const Newton *newton = simulation->run[0].newton;
    if (!newton || !(simulation->scene->needs & NEEDS_SPRINGS))
        return;
    print(file, "solver", "%s%s%s", solver_name(newton->working),
          newton->refusal ? "; no multigrid: " : "",
          newton->refusal ? newton->refusal : "");
}

/* What the minimisations took; nothing with explicit methods, which have none.
 * Where contact and friction need a smaller tolerance. */
static void print_newton(FILE *file, const Simulation *simulation)
{
    NewtonCounters sum = simulation_counters(simulation);
    bool in_time = simulation->scene->needs & NEEDS_TIME;
    bool minimises = !in_time && (simulation->scene->needs & NEEDS_START);
    double needed;
    const struct {
        const char *name;
        long long count; /* 0: nothing is to be told */
    } rows[] = {
        {"factorisations", sum.factorisations},
        {"solves", sum.solves},
        {"blocks projected", sum.projected},
        {"V-cycles", sum.cycles},
        {"saddles left", sum.saddles},
    };
    for (int i = 0; i < simulation->runs && in_time; i++)
        minimises = minimises || simulation->run[i].newton;
    print_solver(file, simulation);
    if (simulation_is_loose(simulation, &needed))
        print(file, "tolerance",
              "%g m/s is loose: bodies may hang or freeze; %.3g is not",
              simulation->options.tolerance, needed);
    if (!minimises)
        return;
    print(file, "Newton iterations", "%ld",
          in_time ? sum.iterations : simulation->descent.count);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].count > 0)
            print(file, rows[i].name, "%lld", rows[i].count);
}

/* Of the first run; where there are several, with its name. */
static void print_energies(FILE *file, const Player *player, int pane)
{
    const Machine *machine = &player->past.machine[pane];
    const Simulation *simulation = &machine->simulation;
    const double energy[] = {machine->begin,
                             simulation_energies(simulation, 0).total};
    bool several = simulation->runs > 1;
    for (int i = 0; i < 2; i++) {
        char text[32] = "too large for a number";
        if (isfinite(energy[i]))
            snprintf(text, sizeof text, "%.9g J", energy[i]);
        print(file, i == 0 ? "energy at start" : "energy at end", "%s%s%s",
              text, several ? ", " : "",
              several ? simulation->run[0].method->name : "");
    }
}

/* The folder of the frames and the last film. */
static void print_frames(FILE *file, const Recording *recording)
{
    char name[256];
    one_line(recording->folder, name, sizeof name);
    if (recording->folder)
        print(file, "frames written", "%ld, in %s/", recording->frames, name);
    else if (!recording->film_told[0])
        print(file, "frames written", "0");
    if (recording->film_told[0])
        print(file, "film", "%s", recording->film_told);
}

static void print_unconverged(FILE *file, const Simulation *simulation)
{
    fprintf(file, "steps not converged %ld", simulation->unconverged);
    if (simulation->unconverged > 0)
        fprintf(file, ", the first: %s", status_name(simulation->first));
    for (int i = 0; i < STATUS_COUNT; i++)
        if (simulation->reasons[i] > 0)
            fprintf(file, "\n  %-17s %d", status_name((Status)i),
                    simulation->reasons[i]);
    fputc('\n', file);
}

/* How far a pane came, what it took, and where that led. */
static void print_pane(FILE *file, const Player *player, int pane)
{
    const Simulation *simulation = &player->past.machine[pane].simulation;
    bool in_time = simulation->scene->needs & NEEDS_TIME;
    print(file, "steps", "%ld", simulation->steps);
    if (in_time)
        print(file, "simulated time", "%g s", simulation_time(simulation));
    print_newton(file, simulation);
    if (in_time)
        print_energies(file, player, pane);
    print_unconverged(file, simulation);
}

/* One quantity a line; of several panes those of each, one after the other. */
void summary_print(FILE *file, const Player *player)
{
    int panes = past_panes(&player->past);
    for (int i = 0; i < panes; i++) {
        if (panes > 1)
            fprintf(file, "pane %-14d %s\n", i + 1, player->side[i].label);
        print_pane(file, player, i);
        if (panes > 1)
            fputc('\n', file);
    }
    print(file, "wall time", "%.3f s", clock_now() - player->started);
    print_frames(file, &player->recording);
    print(file, "state hash", "%016llx",
          (unsigned long long)player_hash(player));
}
