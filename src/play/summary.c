#include "play/player.h"

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

/* Who made the first run's last step, and why it was not multigrid; where
 * contact and friction need a smaller tolerance; what minimising took. */
static void print_newton(FILE *file, const Simulation *simulation)
{
    const Newton *newton = simulation->run[0].newton;
    NewtonCounters sum = simulation_counters(simulation);
    unsigned needs = simulation->scene->needs;
    double needed;
    const struct {
        const char *name;
        long long count; /* 0: nothing is to be told */
    } rows[] = {
        {"Newton iterations",
         needs & NEEDS_TIME ? sum.iterations : simulation->descent.count},
        {"factorisations", sum.factorisations},
        {"solves", sum.solves},
        {"blocks projected", sum.projected},
        {"V-cycles", sum.cycles},
        {"saddles left", sum.saddles},
    };
    if (newton && needs & NEEDS_SPRINGS)
        print(file, "solver", "%s%s%s", solver_name(newton->working),
              newton->refusal ? "; no multigrid: " : "",
              newton->refusal ? newton->refusal : "");
    if (simulation_is_loose(simulation, &needed))
        print(file, "tolerance",
              "%g m/s is loose: bodies may hang or freeze; %.3g is not",
              simulation->options.tolerance, needed);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].count > 0)
            print(file, rows[i].name, "%lld", rows[i].count);
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

/* How far a pane came, what it took, and where that led its first run. */
static void print_pane(FILE *file, const Machine *machine)
{
    const Simulation *simulation = &machine->simulation;
    bool in_time = simulation->scene->needs & NEEDS_TIME;
    print(file, "steps", "%ld", simulation->steps);
    if (in_time)
        print(file, "simulated time", "%g s", simulation_time(simulation));
    print_newton(file, simulation);
    if (in_time) {
        print(file, "energy at start", "%.9g J", machine->begin);
        print(file, "energy at end", "%.9g J",
              simulation_energies(simulation, 0).total);
    }
    print_unconverged(file, simulation);
}

/* One quantity a line; of several panes those of each, one after the other. */
void summary_print(FILE *file, const Player *player)
{
    const Recording *recording = &player->recording;
    int panes = past_panes(&player->past);
    char name[256];
    for (int i = 0; i < panes; i++) {
        if (panes > 1)
            fprintf(file, "pane %-14d %s\n", i + 1, player->side[i].label);
        print_pane(file, &player->past.machine[i]);
        if (panes > 1)
            fputc('\n', file);
    }
    print(file, "wall time", "%.3f s", clock_now() - player->started);
    if (recording->folder) {
        one_line(recording->folder, name, sizeof name);
        print(file, "frames written", "%ld, in %s/", recording->frames, name);
    }
    if (recording->film_told[0])
        print(file, "film", "%s", recording->film_told);
    print(file, "state hash", "%016llx",
          (unsigned long long)player_hash(player));
}
